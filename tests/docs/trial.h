// SPDX-License-Identifier: Apache-2.0
// How an example command of the pages is tried: as it stands, unless a rule says otherwise.
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

// In their order: the first of kElsewhere or kNotHere that matches a command takes it, all of
// kSmaller that match change it.
const std::vector<TrialRule>& TrialRules();

// The command for the shell: the original, a smaller one, or ":". Adds the numbers of the rules
// that were used to `used`.
std::string Tried(const std::string& command, std::vector<size_t>* used);

}  // namespace shoal
