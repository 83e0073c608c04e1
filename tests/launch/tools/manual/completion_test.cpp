// SPDX-License-Identifier: Apache-2.0
// Runs the built completions in their shells and compares the results with --help of the built
// programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/config/key_description.h"
#include "tests/launch/tools/manual/help_text.h"
#include "tests/support/program.h"

namespace shoal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsSupersetOf;
using Set = std::set<std::string>;

// A shell and the script that prints, for each command line asked for, "ASK NUMBER" and the words
// offered for its last word.
struct Harness {
  std::string shell;
  std::string start;                                    // loads the completion
  std::string (*ask)(const std::vector<std::string>&);  // a line of the script
};

std::string Quoted(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += " '" + word + "'";
  return text;
}

std::string Line(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

// In bash '=' is a word of its own on a command line.
std::vector<std::string> BashWords(const std::vector<std::string>& words) {
  std::vector<std::string> split;
  for (const std::string& word : words) {
    const size_t equals = word.find('=');
    if (equals == std::string::npos) {
      split.push_back(word);
      continue;
    }
    split.insert(split.end(), {word.substr(0, equals), "="});
    if (equals + 1 < word.size()) split.push_back(word.substr(equals + 1));
  }
  return split;
}

Harness Bash() {
  return {.shell = "bash",
          .start = "source " + SharePath("bash-completion/completions/shoal") +
                   "\nask() { COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _shoal; "
                   "((${#COMPREPLY[@]} == 0)) || printf '%s\\n' \"${COMPREPLY[@]}\"; }\n",
          .ask = [](const std::vector<std::string>& words) {
            return "ask" + Quoted(BashWords(words)) + "\n";
          }};
}

// compadd and compset work only in the line editor, so they are replaced: they print their
// arguments.
Harness Zsh() {
  return {
      .shell = "zsh",
      .start =
          "compadd() { local name=${@[-1]}; print -l -- ${(P)name} }\n"
          "compset() { }\n_files() { }\nwords=(nothing) CURRENT=1\n"
          "source " +
          SharePath("zsh/vendor-completions/_shoal") +
          "\nask() { words=(\"$@\") CURRENT=$#; _shoal }\n",
      .ask = [](const std::vector<std::string>& words) { return "ask" + Quoted(words) + "\n"; }};
}

Harness Fish() {
  return {.shell = "fish",
          .start = "source " + SharePath("fish/vendor_completions.d/shoal.fish") + "\n",
          .ask = [](const std::vector<std::string>& words) {
            return "complete -C '" + Line(words) + "' | string replace -r '\\t.*' ''\n";
          }};
}

Harness HarnessOf(const std::string& shell) {
  if (shell == "bash") return Bash();
  return shell == "zsh" ? Zsh() : Fish();
}

class Completion : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (std::system(("command -v " + harness_.shell + " >/dev/null").c_str()) != 0) {
      GTEST_SKIP() << "needs " << harness_.shell << " (Debian's " << harness_.shell << ")";
    }
  }

  // The words offered for the last word of each command line, in its whole: NAME=VALUE where that
  // is asked for.
  std::vector<Set> Offers(const std::vector<std::vector<std::string>>& lines) {
    const TemporaryFolder folder;
    std::string script = harness_.start;
    for (const auto& words : lines) script += "echo ASK\n" + harness_.ask(words);
    WriteFileAtomically(folder.path() / "script", script);
    const ProgramResult result = RunCommand({"/usr/bin/env", "HOME=" + folder.path().string(),
                                             harness_.shell, (folder.path() / "script").string()},
                                            std::chrono::seconds(120));
    EXPECT_EQ(result.err, "");
    std::vector<Set> offers;
    std::istringstream output(result.out);
    for (std::string line; std::getline(output, line);) {
      if (line == "ASK") {
        offers.emplace_back();
        continue;
      }
      if (offers.empty()) {
        ADD_FAILURE() << "before the first question: " << line;
        return {};
      }
      const std::string& current = lines[offers.size() - 1].back();
      const size_t equals = current.find('=');
      const bool whole = equals == std::string::npos || line.starts_with(current.substr(0, equals));
      const std::string word = whole ? line : current.substr(0, equals + 1) + line;
      // zsh's compadd itself leaves out what does not begin so.
      if (word.starts_with(current)) offers.back().insert(word);
    }
    EXPECT_EQ(offers.size(), lines.size()) << result.out;
    offers.resize(lines.size());
    return offers;
  }

  Set Offer(const std::vector<std::string>& words) { return Offers({words})[0]; }

 private:
  const Harness harness_ = HarnessOf(GetParam());
};

TEST_P(Completion, OffersTheOptionsAndCommandsThatHelpHas) {
  std::vector<std::vector<std::string>> lines;
  std::vector<Set> expected;
  for (const HelpText& help : AllHelp()) {
    lines.push_back(help.words);
    lines.back().push_back("--");
    expected.emplace_back();
    std::ranges::copy_if(help.flags, std::inserter(expected.back(), expected.back().end()),
                         [](const std::string& flag) { return flag.starts_with("--"); });
    if (help.commands.empty()) continue;
    for (const std::string& command : help.commands) {
      lines.push_back(help.words);
      lines.back().push_back(command.substr(0, command.size() - 1));
      expected.emplace_back();
      std::ranges::copy_if(
          help.commands, std::inserter(expected.back(), expected.back().end()),
          [&](const std::string& other) { return other.starts_with(lines.back().back()); });
    }
  }
  const std::vector<Set> offers = Offers(lines);
  for (size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(offers[i], expected[i]) << Line(lines[i]);
}

TEST_P(Completion, OffersPresetsTasksAndChoices) {
  const std::vector<std::string> presets = ListPresets();
  const auto offers = Offers({{"shoal", "train", "--preset", "f"},
                              {"shoal", "train", "--preset=hopper-p"},
                              {"shoal", "eval", "--task", "FetchPu"},
                              {"shoal", "env", "describe", "FetchPu"},
                              {"shoal", "env", "render", "--quality", "r"},
                              {"shoal", "experiment", "run", "reach-th"},
                              {"shoal", "plot", "--reference", "p"},
                              {"shoal-actor", "--role", "e"}});
  Set fetch;
  std::ranges::copy_if(presets, std::inserter(fetch, fetch.end()),
                       [](const std::string& name) { return name.starts_with('f'); });
  EXPECT_EQ(offers[0], fetch);
  EXPECT_THAT(offers[1], ElementsAre("--preset=hopper-ppo"));
  EXPECT_THAT(offers[2], IsSupersetOf({"FetchPush", "FetchPushDense"}));
  EXPECT_THAT(offers[3], IsSupersetOf({"FetchPush", "FetchPushDense"}));
  EXPECT_THAT(offers[4], ElementsAre("reference"));
  EXPECT_THAT(offers[5], ElementsAre("reach-three-way"));
  EXPECT_THAT(offers[6], ElementsAre("planet-6"));
  EXPECT_THAT(offers[7], ElementsAre("eval"));
}

TEST_P(Completion, OffersKeysAndTheirChoices) {
  Set learner;
  for (const KeyDescription& key : DescribeEachKey()) {
    const std::string begun = std::string(key.path) + "=";
    if (begun.starts_with("learner.")) learner.insert(begun);
  }
  const auto offers = Offers({{"shoal", "train", "--set", "learner."},
                              {"shoal", "train", "--set", "learner.algorithm=t"},
                              {"shoal", "set", "lockstep=t"}});
  EXPECT_EQ(offers[0], learner);
  EXPECT_THAT(offers[1], ElementsAre("learner.algorithm=td3"));
  EXPECT_THAT(offers[2], ElementsAre("lockstep=true"));
}

INSTANTIATE_TEST_SUITE_P(Shells, Completion, testing::Values("bash", "zsh", "fish"),
                         [](const auto& shell) { return shell.param; });

}  // namespace
}  // namespace shoal
