#include "launch/watch/terminal_block.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

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
