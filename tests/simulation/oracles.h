// SPDX-License-Identifier: Apache-2.0
// Checks the promises of a run against the files and output of a simulated run.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/link/hub.h"
#include "common/link/reader.h"
#include "tests/simulation/train_session.h"

namespace shoal::simulation {

// Records the acknowledgements that actors receive. `hub` has the role of an actor.
class Witness {
 public:
  explicit Witness(link::Hub& hub)
      : credits_(hub, [this](const CreditsMessage& message) { Hear(message); }) {}

  // The highest acknowledged sequence, by actor and session.
  using Acknowledged = std::map<std::pair<uint32_t, uint64_t>, uint64_t>;
  const Acknowledged& acknowledged() const { return acknowledged_; }

 private:
  void Hear(const CreditsMessage& message);

  Acknowledged acknowledged_;
  link::Reader<CreditsMessage> credits_;
};

struct Facts {
  bool struck = false;         // there were faults
  bool last_clean = true;      // in the last session every process ended cleanly
  bool overwritten = false;    // another run replaced the run
  bool cut = false;            // half of the ring was removed
  bool lost = false;           // the ring was removed
  bool unwritten = false;      // a disk failed
  bool replay_struck = false;  // the replay server was killed, or delayed for long
  // Wall-clock times in s. Between these times no process ended or was delayed for long, and no
  // clock jumped.
  double orderly_from = 0, orderly_until = 0;
  Witness::Acknowledged acknowledged;
};

// Returns one line for each broken promise of a run that has reached its end.
std::vector<std::string> BrokenPromises(const World& world, const Facts& facts);

}  // namespace shoal::simulation
