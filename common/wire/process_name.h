// SPDX-License-Identifier: Apache-2.0
// What a process of a run is called, everywhere: in reports, logs, RUN/sessions, the supervisor.
//
// Of most roles a run has one process. Where code means that one, it says Replay(0) or Learner(): a
// run with several replay servers is a matter of those places (docs/architecture.md).
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
  static constexpr ProcessName Learner() { return {"learner"}; }
  static constexpr ProcessName Replay(uint32_t index) { return {"replay", index}; }
  static constexpr ProcessName Evaluation() { return {"eval"}; }
  static constexpr ProcessName Actor(uint32_t index) { return {"actor", index}; }
};

}  // namespace shoal
