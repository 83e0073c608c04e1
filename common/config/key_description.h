// SPDX-License-Identifier: Apache-2.0
// Description of each configuration key as text, for tables, manuals and completions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shoal {

struct KeyDescription {
  std::string_view path;                // "learner.algorithm"
  std::string default_value;            // JSON
  std::string takes;                    // "sac | td3 | ddpg | ppo", "an integer in 1..65536"
  std::string_view meaning;             // one line, with the unit
  std::vector<std::string_view> words;  // choices, or true and false; empty for other types
};

// All keys, in the order of the configuration.
std::vector<KeyDescription> DescribeEachKey();

}  // namespace shoal
