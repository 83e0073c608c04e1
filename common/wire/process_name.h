// SPDX-License-Identifier: Apache-2.0
// The name of a process of a run, as used in reports, logs, RUN/sessions and the supervisor.
// common/link/run_topology.h lists the processes of a run.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace shoal {

struct ProcessName {
  std::string_view role;  // borrowed; string literals in the functions below
  uint32_t index = 0;     // within the role, from 0

  // "replay-0"
  std::string Text() const { return fmt::format("{}-{}", role, index); }

  static constexpr ProcessName Coordinator() { return {"coordinator"}; }
  static constexpr ProcessName Evaluation() { return {"eval"}; }
  static constexpr ProcessName Actor(uint32_t index) { return {"actor", index}; }
};

}  // namespace shoal
