// SPDX-License-Identifier: Apache-2.0
// Rules for testing the example commands of the pages. If no rule matches, a command runs
// unchanged.
#pragma once

#include <string>
#include <vector>

namespace shoal {

enum class Trial {
  kSmaller,  // `text` replaces the matched part ($1 as in regex), so that the command has less work
  kElsewhere,  // another test covers it: `text` is the test's name, "NewProject.BuildsAndTrains"
  kNotHere,    // the command cannot run in a test: `text` is the reason
};

struct TrialRule {
  std::string pattern;  // ECMAScript, found anywhere in the command
  Trial trial;
  std::string text;
};

// The rules in order. If a kElsewhere or kNotHere rule matches a command, the first such rule
// decides. All matching kSmaller rules change the command.
const std::vector<TrialRule>& TrialRules();

// The command for the shell: the original command, a smaller command, or ":". Adds the numbers of
// the applied rules to `used`.
std::string Tried(const std::string& command, std::vector<size_t>* used);

}  // namespace shoal
