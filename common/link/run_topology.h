// SPDX-License-Identifier: Apache-2.0
// The processes of a run, and the processes to which each of them writes. The following are derived
// from the topology: the process plan, the fixed ports, the counts of stored and lost records, the
// messages that the coordinator accepts, and the displays.
//
// Today each run has one learner and, unless it learns on policy, one replay. A second learner or
// replay needs one more entry of Servers() and the routing between the servers. Code that supports
// exactly one learner or replay calls OnlyLearner() or OnlyReplay().
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "common/config/config.h"
#include "common/link/role.h"
#include "common/link/topic.h"
#include "common/wire/process_name.h"

namespace shoal::link {

struct RunProcess {
  Role role = Role::kCoordinator;
  uint32_t index = 0;  // within the role, from 0
  uint32_t host = 0;   // 0: the coordinator's host; n: the nth of the run's other hosts

  ProcessName Name() const { return {RoleName(role), index}; }
  friend bool operator==(const RunProcess&, const RunProcess&) = default;
};

// The servers that a run can have, in the order of their fixed ports. A run reserves the ports of
// all these servers, even if it does not start all of them.
std::span<const RunProcess> Servers();

// Position in Servers(); empty for a process without a fixed port.
std::optional<int> FixedPort(Role role, uint32_t index);

class RunTopology {
 public:
  // `config` must be resolved; config.actors is the number of all actors. `actors_elsewhere`:
  // number of actors on each other host. These actors have the highest indices, in the order of the
  // hosts.
  explicit RunTopology(const Config& config, std::span<const int> actors_elsewhere = {});

  // The processes that the coordinator starts, in starting order.
  const std::vector<RunProcess>& children() const { return children_; }
  // The children of a role, by index.
  std::vector<RunProcess> Of(Role role) const;
  bool Has(Role role) const { return !Of(role).empty(); }

  // The run's learner, and the run's replay. The run must have exactly one process of this role.
  RunProcess OnlyLearner() const;
  RunProcess OnlyReplay() const;

  // The training actors of a host.
  std::vector<RunProcess> ActorsOn(uint32_t host) const;

  // The children that write the topic of M, and the children that read it, according to the rights
  // of the roles. Actors exchange records and credits with one role only: the replays or, in a run
  // without a replay, the learners.
  template <class M>
  std::vector<RunProcess> WritersOf() const {
    return WritersOf(Topic<M>::kSettings.name);
  }
  template <class M>
  std::vector<RunProcess> ReadersOf() const {
    return ReadersOf(Topic<M>::kSettings.name);
  }
  // The readers of the actors' records. These processes acknowledge the records and count how many
  // of them were stored, rejected or lost.
  std::vector<RunProcess> RecordReceivers() const { return ReadersOf<TransitionChunk>(); }

  // Whether the topic of M can have a writer with this role and index, now or after `shoal scale`
  // has started more actors.
  template <class M>
  bool CanWrite(std::string_view role, uint32_t index) const {
    return CanWrite(Topic<M>::kSettings.name, role, index);
  }

 private:
  std::vector<RunProcess> WritersOf(std::string_view topic) const;
  std::vector<RunProcess> ReadersOf(std::string_view topic) const;
  std::vector<RunProcess> Among(const std::vector<Role>& roles, bool of_records) const;
  bool CanWrite(std::string_view topic, std::string_view role, uint32_t index) const;

  std::vector<RunProcess> children_;
};

}  // namespace shoal::link
