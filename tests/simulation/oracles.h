// SPDX-License-Identifier: Apache-2.0
// The promises of a run, held against what a simulated one left and said.
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

// Hears what is acknowledged to actors. Its hub has the role of one.
class Witness {
 public:
  explicit Witness(link::Hub& hub)
      : credits_(hub, [this](const CreditsMessage& message) { Hear(message); }) {}

  // The highest sequence that was acknowledged, by actor and session.
  using Acknowledged = std::map<std::pair<uint32_t, uint64_t>, uint64_t>;
  const Acknowledged& acknowledged() const { return acknowledged_; }

 private:
  void Hear(const CreditsMessage& message);

  Acknowledged acknowledged_;
  link::Reader<CreditsMessage> credits_;
};

struct Facts {
  bool struck = false;         // there were faults
  bool last_clean = true;      // every process left in order in the last session
  bool overwritten = false;    // another run took the folder
  bool cut = false;            // half of the ring was removed
  bool lost = false;           // the ring was removed
  bool unwritten = false;      // a disk failed
  bool replay_struck = false;  // the replay server was killed, or held up for long
  // Wall clock, s: between, no process left or was held up for long, and no clock jumped.
  double orderly_from = 0, orderly_until = 0;
  Witness::Acknowledged acknowledged;
};

// Returns one line for each promise that a run which has reached its end does not keep.
std::vector<std::string> BrokenPromises(const World& world, const Facts& facts);

}  // namespace shoal::simulation
