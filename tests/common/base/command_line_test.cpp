// SPDX-License-Identifier: Apache-2.0
#include "common/base/command_line.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "tests/support/error_message.h"

namespace shoal {
namespace {

using Words = std::vector<std::string>;

class CommandLineTest : public testing::Test {
 protected:
  CommandLineTest() {
    app_.add_option("--level", level_, "of all");
    app_.add_option("--tag", tag_, "of all");
    app_.require_subcommand(1);
    app_.fallthrough();
    app_.add_subcommand("erase", "");
    CLI::App* draw = app_.add_subcommand("draw", "");
    draw->add_option("--width", width_, "");
    draw->add_option("--name", names_, "");
    draw->add_option("file", file_, "")->required();
  }
  std::string Refusal(const Words& words, const WordHint& hint = nullptr) {
    return UsageMessage([&] { ParseCommandLine(&app_, words, hint); });
  }

  CLI::App app_{"A program.", "p"};
  int level_ = 0, width_ = 0;
  Words names_;
  std::string file_, tag_;
};

TEST_F(CommandLineTest, TakesWordsInTheirOrder) {
  EXPECT_EQ(ParseCommandLine(&app_, Words{"draw", "f", "--width", "3", "--level", "-2"}),
            std::nullopt);
  EXPECT_EQ(file_, "f");
  EXPECT_EQ(width_, 3);
  EXPECT_EQ(level_, -2);
}

TEST_F(CommandLineTest, AnUnknownOptionIsNamedBeforeItsValueWithTheNearestOne) {
  EXPECT_EQ(Refusal({"draw", "f", "--widht", "3"}),
            "draw: unknown option '--widht'; nearest is '--width' (see p draw --help)");
  EXPECT_EQ(Refusal({"draw", "f", "--widht=3"}),
            "draw: unknown option '--widht'; nearest is '--width' (see p draw --help)");
  EXPECT_EQ(Refusal({"draw", "f", "--levle", "3"}),
            "draw: unknown option '--levle'; nearest is '--level' (see p draw --help)")
      << "also of the command above";
  EXPECT_EQ(Refusal({"draw", "f", "--quux"}), "draw: unknown option '--quux' (see p draw --help)");
}

TEST_F(CommandLineTest, AnUnknownOptionComesBeforeWhatIsMissing) {
  EXPECT_EQ(Refusal({"draw", "--widht", "3"}),
            "draw: unknown option '--widht'; nearest is '--width' (see p draw --help)");
}

TEST_F(CommandLineTest, ValuesAreNeitherOptionsNorCommands) {
  EXPECT_EQ(Refusal({"--tag", "erase", "draw", "--name", "draw", "b", "--other"}),
            "draw: unknown option '--other' (see p draw --help)");
}

TEST_F(CommandLineTest, AnUnexpectedWordIsNamed) {
  EXPECT_EQ(Refusal({"draw", "f", "g"}), "draw: unexpected argument 'g' (see p draw --help)");
}

TEST_F(CommandLineTest, WhatTheProgramKnowsOfAWordIsSaidInPlaceOfTheNearest) {
  const WordHint hint = [](const CLI::App& command, const std::string& word) {
    return word == "--widht" || word == "g" ? "; " + command.get_name() + " knows " + word : "";
  };
  EXPECT_EQ(Refusal({"draw", "f", "--widht", "3"}, hint),
            "draw: unknown option '--widht'; draw knows --widht (see p draw --help)");
  EXPECT_EQ(Refusal({"draw", "f", "g"}, hint),
            "draw: unexpected argument 'g'; draw knows g (see p draw --help)");
  EXPECT_EQ(Refusal({"draw", "f", "--nmae", "3"}, hint),
            "draw: unknown option '--nmae'; nearest is '--name' (see p draw --help)");
}

TEST_F(CommandLineTest, WhatIsMissingIsSaidWithTheUsage) {
  EXPECT_EQ(Refusal({"draw"}), "draw: file is required; usage: p draw [OPTIONS] file");
}

TEST_F(CommandLineTest, AValueThatIsNoneIsNamedWithTheCommandsHelp) {
  EXPECT_EQ(Refusal({"draw", "f", "--width", "x"}),
            "draw: Could not convert: --width = x (see p draw --help)");
}

}  // namespace
}  // namespace shoal
