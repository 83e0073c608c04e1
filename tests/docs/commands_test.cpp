// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "common/base/files.h"
#include "common/config/key_description.h"
#include "common/config/meant_key.h"
#include "tests/launch/tools/manual/help_text.h"
#include "tests/support/paths.h"

namespace shoal {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> Texts(const std::string& page) {
  std::vector<std::string> texts;
  for (const Block& block : ParsePage("a.md", page).blocks) {
    for (const Command& command : CommandsOf(block)) texts.push_back(command.text);
  }
  return texts;
}

TEST(DocsCommands, LinesOfShellBlocksAndOfTranscriptsAreCommands) {
  EXPECT_THAT(Texts("```sh\na b   # why\n\n# alone\nc \\\n  d\n```\n"),
              ElementsAre("a b   # why", "c \\\n  d"));
  EXPECT_THAT(Texts("1. x\n\n   ```sh\n   a\n   ```\n"), ElementsAre("a"));
  EXPECT_THAT(Texts("```\n$ a\nwhat it says\n$ b\n```\n"), ElementsAre("a", "b"));
  EXPECT_THAT(Texts("```json\n$ a\n```\n```\nplain\n```\n"), IsEmpty());
  EXPECT_THAT(Texts("```sh\nfor a in 1 2; do\n  b\ndone\nc 'x\ny'\n```\n"),
              ElementsAre("for a in 1 2; do\n  b\ndone", "c 'x\ny'"));
}

TEST(DocsCommands, CallsAreFoundWithTheirWords) {
  EXPECT_THAT(OwnCalls("X=1 build/release/bin/shoal top --once > f  # shoal no"),
              ElementsAre(ElementsAre("shoal", "top", "--once")));
  EXPECT_THAT(OwnCalls("for s in 1; do\n  shoal a \\\n  --b\n  ./run c; shoal-actor\ndone"),
              ElementsAre(ElementsAre("shoal", "a", "--b"), ElementsAre("./run", "c"),
                          ElementsAre("shoal-actor")));
}

// The fault of a call, or empty: commands, options and keys must exist. Placeholders (NAME, …) are
// accepted.
std::string CallFault(const std::vector<std::string>& call) {
  static const std::set<std::string_view> keys = [] {
    std::set<std::string_view> paths;
    for (const KeyDescription& key : DescribeEachKey()) paths.insert(key.path);
    return paths;
  }();
  const auto find = [](const std::vector<std::string>& words) {
    const auto is = [&](const HelpText& help) { return help.words == words; };
    const auto it = std::ranges::find_if(AllHelp(), is);
    return it == AllHelp().end() ? nullptr : &*it;
  };
  std::vector<std::string> words = {call[0] == "./run" ? "shoal" : call[0]};
  const HelpText* help = find(words);
  std::set<std::string> flags = help->flags;  // those of commands above hold below, too
  for (size_t i = 1; i < call.size(); ++i) {
    const std::string& word = call[i];
    const std::string flag = word.substr(0, word.find('='));
    // Keys are options of `shoal train`, too.
    const bool key =
        help->name() == "shoal train" && flag.size() > 2 && FindMeantKey(flag.substr(2)).same;
    if (word.starts_with("--") && !flags.contains(flag) && !key) {
      return help->name() + " has no " + flag;
    }
    if (i > 1 && call[i - 1] == "--set" && std::islower(static_cast<unsigned char>(word[0])) != 0 &&
        !keys.contains(word.substr(0, word.find('=')))) {
      return "no key " + word;
    }
    if (word.starts_with("-") || help->commands.empty()) continue;
    if (std::islower(static_cast<unsigned char>(word[0])) == 0) break;  // COMMAND
    words.push_back(word);
    help = find(words);
    if (help == nullptr) return "no command '" + word + "'";
    flags.insert(help->flags.begin(), help->flags.end());
  }
  return "";
}

// `./run` has commands of its own, each a branch of its last `case`.
bool IsRunsOwn(const std::string& command) {
  static const std::string script = ReadFile(SourcePath("run"));
  return script.find("\n  " + command + ")\n") != std::string::npos;
}

std::vector<std::string> CallFaults(const std::vector<Page>& pages, size_t* calls) {
  std::vector<std::string> faults;
  const auto look = [&](const Page& page, int line, const std::string& text) {
    for (const std::vector<std::string>& call : OwnCalls(text)) {
      ++*calls;
      if (call[0] == "./run" && (call.size() == 1 || IsRunsOwn(call[1]))) continue;
      const std::string fault = CallFault(call);
      if (!fault.empty()) faults.push_back(page.file + ":" + std::to_string(line) + ": " + fault);
    }
  };
  for (const Page& page : pages) {
    for (const Block& block : page.blocks) {
      for (const Command& command : CommandsOf(block)) look(page, command.line, command.text);
    }
    for (const auto& [line, code] : page.code) look(page, line, code);
  }
  return faults;
}

TEST(DocsCommands, CommandsOptionsAndKeysOfEveryCallAreThere) {
  std::vector<Page> pages = ReadPages(SourcePath(""));
  std::erase_if(pages, [](const Page& page) { return page.file == "CHANGELOG.md"; });  // history
  size_t calls = 0;
  EXPECT_THAT(CallFaults(pages, &calls), IsEmpty());
  EXPECT_GT(calls, 200u);
}

TEST(DocsCommands, WhatIsNotThereIsNamed) {
  size_t calls = 0;
  const Page page =
      ParsePage("a.md",
                "`shoal tap`, `shoal top --twice`, `./run tram`, `./run build`\n"
                "```sh\nshoal train --set sead=3 --set seed=3\n```\n`shoal env NAME`\n");
  EXPECT_THAT(CallFaults({page}, &calls),
              ElementsAre("a.md:3: no key sead=3", "a.md:1: no command 'tap'",
                          "a.md:1: shoal top has no --twice", "a.md:1: no command 'tram'"));
  EXPECT_EQ(calls, 6u);
}

// Blocks with commands must be marked as such, because commands in other blocks are not tested.
TEST(DocsCommands, BlocksThatBeginWithACommandAreMarkedAsShell) {
  std::vector<std::string> unmarked;
  for (const Page& page : ReadPages(SourcePath(""))) {
    for (const Block& block : page.blocks) {
      if (!block.language.empty() || block.lines.empty()) continue;
      const std::string& first = block.lines[0];
      const bool call = !OwnCalls(first.substr(0, first.find(' '))).empty();
      if (call) unmarked.push_back(page.file + ":" + std::to_string(block.line) + ": " + first);
    }
  }
  EXPECT_THAT(unmarked, IsEmpty());
}

}  // namespace
}  // namespace shoal
