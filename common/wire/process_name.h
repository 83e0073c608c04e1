// SPDX-License-Identifier: Apache-2.0
// The name of a process of a run, everywhere: in reports, logs, RUN/sessions, the supervisor. Which
// processes a run has is in common/link/run_topology.h.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace shoal {

struct ProcessName {
  std::string_view role;  // borrowed; of the functions below, forever
  uint32_t index = 0;     // within the role, from 0

  // "replay-0"
  std::string Text() const { return fmt::format("{}-{}", role, index); }

  static constexpr ProcessName Coordinator() { return {"coordinator"}; }
  static constexpr ProcessName Evaluation() { return {"eval"}; }
  static constexpr ProcessName Actor(uint32_t index) { return {"actor", index}; }
};

}  // namespace shoal
