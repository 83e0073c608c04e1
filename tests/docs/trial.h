// SPDX-License-Identifier: Apache-2.0
// Rules for testing the example commands of the pages. Without a matching rule a command runs
// unchanged.
#pragma once

#include <string>
#include <vector>

namespace shoal {

enum class Trial {
  kSmaller,    // run with less to do: `text` replaces what the pattern matches ($1 as in regex)
  kElsewhere,  // a test does what it does: `text` is its name, "NewProject.BuildsAndTrains"
  kNotHere,    // cannot run in a test: `text` is the reason
};

struct TrialRule {
  std::string pattern;  // ECMAScript, found anywhere in the command
  Trial trial;
  std::string text;
};

// The rules in order. The first matching kElsewhere or kNotHere decides about a command; all
// matching kSmaller rules change it.
const std::vector<TrialRule>& TrialRules();

// The command for the shell: the original, a smaller one, or ":". Adds the numbers of the applied
// rules to `used`.
std::string Tried(const std::string& command, std::vector<size_t>* used);

}  // namespace shoal
