// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/terminal_block.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

using Lines = std::vector<std::string>;

TEST(TerminalBlock, ColumnsAreThoseOfCharacters) {
  EXPECT_EQ(ColumnsOf(""), 0u);
  EXPECT_EQ(ColumnsOf("run"), 3u);
  EXPECT_EQ(ColumnsOf("l\xc3\xa4uft"), 5u);
}

TEST(TerminalBlock, TextIsCutBetweenCharacters) {
  EXPECT_EQ(CutToColumns("l\xc3\xa4uft", 2), "l\xc3\xa4");
  EXPECT_EQ(CutToColumns("l\xc3\xa4uft", 1), "l");
  EXPECT_EQ(CutToColumns("l\xc3\xa4uft", 0), "");
  EXPECT_EQ(CutToColumns("l\xc3\xa4uft", 9), "l\xc3\xa4uft");
}

TEST(TerminalBlock, LinesAreBrokenAtWords) {
  EXPECT_EQ(WrapToColumns("one two three", 20), Lines({"one two three"}));
  EXPECT_EQ(WrapToColumns("one two three", 7), Lines({"one two", "  three"}));
  EXPECT_EQ(WrapToColumns("one two three", 8, false), Lines({"one two", "three"}));
  EXPECT_EQ(WrapToColumns("  one two", 7), Lines({"  one", "    two"}));
  EXPECT_EQ(WrapToColumns("", 5), Lines({""}));
}

TEST(TerminalBlock, WordsThatNoLineHoldsAreCut) {
  EXPECT_EQ(WrapToColumns("abcdefgh", 5, false), Lines({"abcde", "fgh"}));
  EXPECT_EQ(WrapToColumns("  abcdefgh", 6), Lines({"  abcd", "    ef", "    gh"}));
  EXPECT_EQ(WrapToColumns("l\xc3\xa4uft", 2, false), Lines({"l\xc3\xa4", "uf", "t"}));
  EXPECT_EQ(WrapToColumns("ab", 1), Lines({"a", "b"}));
}

TEST(TerminalBlock, LinesThatANarrowerTerminalHasWrappedTakeMoreRows) {
  EXPECT_EQ(RowsOf({79, 10, 0}, 80), 3);
  EXPECT_EQ(RowsOf({80, 10}, 80), 2);
  EXPECT_EQ(RowsOf({79, 10, 0}, 40), 4);
  EXPECT_EQ(RowsOf({81}, 80), 2);
  EXPECT_EQ(RowsOf({}, 80), 0);
  EXPECT_EQ(RowsOf({5}, 0), 5);
}

}  // namespace
}  // namespace shoal::launch
