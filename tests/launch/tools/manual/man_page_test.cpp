// SPDX-License-Identifier: Apache-2.0
// Compares the built manual pages with --help of the built programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <sstream>

#include "common/base/files.h"
#include "common/config/key_description.h"
#include "tests/launch/tools/manual/help_text.h"
#include "tests/support/program.h"

namespace shoal {
namespace {

using ::testing::HasSubstr;

// The page as it is read: no fonts, no escapes.
std::string Plain(std::string roff) {
  const std::pair<const char*, const char*> escapes[] = {
      {"\\\\f[BIR]", ""}, {"\\\\&", ""},      {"\\\\-", "-"},     {"\\\\\\(ha", "^"},
      {"\\\\\\(ti", "~"}, {"\\\\\\(aq", "'"}, {"\\\\\\(ga", "`"}, {"\\\\e", "\\"}};
  for (const auto& [escape, plain] : escapes) {
    roff = std::regex_replace(roff, std::regex(escape), plain);
  }
  return roff;
}

// Names after .TP, by the command whose section they stand in.
struct Page {
  std::map<std::string, std::set<std::string>> flags, arguments;
  std::string text;
};

Page ReadPage(const std::string& program) {
  Page page;
  page.text = Plain(ReadFile(SharePath("man/man1/" + program + ".1")));
  std::istringstream lines(page.text);
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(".SH ")) section = line == ".SH OPTIONS" ? program : "";
    if (line.starts_with(".SS ")) section = line.substr(4);
    if (line != ".TP" || section.empty()) continue;
    std::getline(lines, line);
    if (!line.starts_with('-')) {
      page.arguments[section].insert(line.substr(0, line.find(' ')));
      continue;
    }
    std::istringstream words(line);
    for (std::string word; words >> word && word.starts_with('-');) {
      const bool more = word.ends_with(',');
      if (more) word.pop_back();
      page.flags[section].insert(word);
      if (!more) break;
    }
  }
  return page;
}

TEST(ManPage, HasTheOptionsAndArgumentsThatHelpHas) {
  for (const HelpText& help : AllHelp()) {
    const Page page = ReadPage(help.words[0]);
    const auto flags = page.flags.find(help.name());
    ASSERT_NE(flags, page.flags.end()) << help.name();
    EXPECT_EQ(flags->second, help.flags) << help.name();
    const auto arguments = page.arguments.find(help.name());
    EXPECT_EQ(arguments == page.arguments.end() ? std::set<std::string>{} : arguments->second,
              help.arguments)
        << help.name();
    EXPECT_THAT(page.text, HasSubstr(help.description));
  }
}

TEST(ManPage, HasNoCommandThatHelpDoesNotHave) {
  std::set<std::string> named;
  for (const HelpText& help : AllHelp()) named.insert(help.name());
  EXPECT_GT(named.size(), 25u);
  for (const auto& [section, flags] : ReadPage("shoal").flags) EXPECT_TRUE(named.contains(section));
}

TEST(ManPage, OfTheConfigurationHasEveryKey) {
  const std::string page = Plain(ReadFile(SharePath("man/man5/shoal-configuration.5")));
  for (const KeyDescription& key : DescribeEachKey()) {
    EXPECT_THAT(page, HasSubstr(".TP\n" + std::string(key.path) + " = " + key.default_value + "\n" +
                                std::string(key.meaning) + ".\n.br\nTakes " + key.takes + ".\n"));
  }
}

TEST(ManPage, IsFormattedWithoutAWarning) {
  if (std::system("command -v groff >/dev/null") != 0) {
    GTEST_SKIP() << "needs groff (Debian's groff-base)";
  }
  for (const char* page : {"man1/shoal.1", "man1/shoal-actor.1", "man1/shoal-learner.1",
                           "man1/shoal-replay.1", "man5/shoal-configuration.5"}) {
    const ProgramResult result = RunCommand({"/usr/bin/groff", "-man", "-ww", "-Tutf8", "-rLL=100n",
                                             SharePath(std::string("man/") + page)},
                                            std::chrono::seconds(60));
    EXPECT_EQ(ExitCode(result), 0) << page;
    EXPECT_EQ(result.err, "") << page;
    EXPECT_THAT(result.out, HasSubstr("shoal")) << page;
  }
}

}  // namespace
}  // namespace shoal
