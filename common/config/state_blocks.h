// SPDX-License-Identifier: Apache-2.0
// A selection of a task's blocks, as keys of the configuration have it.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace shoal {

// All blocks, no block, or the named blocks.
struct StateBlocks {
  bool all = false;
  std::vector<std::string> names{};  // the named blocks, if not `all`

  StateBlocks(bool every) : all(every) {}  // NOLINT(google-explicit-constructor): true | false
  explicit StateBlocks(std::vector<std::string> some) : names(std::move(some)) {}
  // Whether any block is selected.
  explicit operator bool() const { return all || !names.empty(); }
};

}  // namespace shoal
