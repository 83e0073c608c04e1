// SPDX-License-Identifier: Apache-2.0
#include "common/image/frame_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::image {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class FrameStreamTest : public testing::Test {
 protected:
  // Two frames of one grey camera of 1 x 2 pixels, a view of 1 x 1, one action component.
  static FrameStreamHeader Header() {
    return {.magic = {},
            .channels = 2,
            .height = 1,
            .width = 2,
            .frame_channels = 1,
            .view_height = 1,
            .view_width = 1,
            .action_size = 1,
            .step_microseconds = 40'000};
  }
  void WriteTwo() const {
    FrameStreamWriter writer(file_, Header());
    writer.Write({.episode = 0, .step = 0, .reward = 0, .flags = 0}, std::vector<float>{0},
                 std::vector<uint8_t>{1, 2, 1, 2}, std::vector<uint8_t>{7, 8, 9});
    writer.Write({.episode = 0, .step = 1, .reward = -0.5F, .flags = kShownSuccess | kShownEnd},
                 std::vector<float>{0.25F}, std::vector<uint8_t>{1, 2, 3, 4},
                 std::vector<uint8_t>{10, 11, 12});
  }
  // The reader's error for other bytes in place of the file's.
  std::string Refusal(const std::string& bytes) const {
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << bytes;
    try {
      FrameStreamReader reader(file_);
      while (reader.Next()) {
      }
    } catch (const Error& e) {
      return e.what();
    }
    return "read to its end";
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "frames";
};

TEST_F(FrameStreamTest, IsReadAsItWasWritten) {
  WriteTwo();
  FrameStreamReader reader(file_);
  EXPECT_EQ(reader.header().channels, 2u);
  EXPECT_EQ(reader.header().frame_channels, 1u);
  EXPECT_EQ(reader.header().step_microseconds, 40'000u);
  auto frame = reader.Next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->record.step, 0u);
  EXPECT_THAT(frame->input, ElementsAre(1, 2, 1, 2));
  EXPECT_THAT(frame->view, ElementsAre(7, 8, 9));
  frame = reader.Next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->record.step, 1u);
  EXPECT_EQ(frame->record.reward, -0.5F);
  EXPECT_EQ(frame->record.flags, kShownSuccess | kShownEnd);
  EXPECT_THAT(frame->action, ElementsAre(0.25F));
  EXPECT_THAT(frame->input, ElementsAre(1, 2, 3, 4));
  EXPECT_FALSE(reader.Next());
}

TEST_F(FrameStreamTest, ItsBytesAreThoseOfTheHeaderFile) {
  WriteTwo();
  const std::string bytes = ReadFile(file_);
  ASSERT_EQ(bytes.size(), 40u + 2 * (16 + 4 + 4 + 3));
  EXPECT_EQ(bytes.substr(0, 16), std::string("SHOALFS1\2\0\0\0\1\0\0\0", 16));
  const std::string second = bytes.substr(40 + 27);
  EXPECT_EQ(second,
            std::string("\0\0\0\0\1\0\0\0\0\0\0\xbf\3\0\0\0\0\0\x80\x3e\1\2\3\4\n\v\f", 27));
}

TEST_F(FrameStreamTest, WhatIsNoStreamIsRefusedByName) {
  WriteTwo();
  const std::string whole = ReadFile(file_);
  EXPECT_EQ(Refusal(whole), "read to its end");
  std::string other = whole;
  other[7] = '2';
  EXPECT_THAT(Refusal(other), AllOf(HasSubstr("frames'"), HasSubstr("SHOALFS1")));
  EXPECT_THAT(Refusal(""), HasSubstr("not a stream"));
  EXPECT_THAT(Refusal(whole.substr(0, 39)), HasSubstr("not a stream"));
  EXPECT_THAT(Refusal(whole.substr(0, whole.size() - 1)), HasSubstr("26 of 27 bytes"));
  EXPECT_THAT(Refusal(whole.substr(0, 41)), HasSubstr("1 of 27 bytes"));
  EXPECT_EQ(Refusal(whole.substr(0, 40)), "read to its end") << "a stream may be empty";
  for (const size_t at : {11, 15, 19, 23, 27, 31, 35}) {
    std::string huge = whole;
    huge[at] = '\x7f';
    EXPECT_THAT(Refusal(huge), HasSubstr("no writer's")) << at;
  }
}

TEST_F(FrameStreamTest, AFileThatCannotBeOpenedOrFilledIsNamed) {
  try {
    FrameStreamWriter writer(folder_.path() / "none" / "frames", Header());
    FAIL() << "wrote into a folder that does not exist";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("none/frames"), HasSubstr("No such file")));
  }
  EXPECT_THROW(FrameStreamReader(folder_.path() / "none"), Error);
  FrameStreamWriter full("/dev/full", Header());
  EXPECT_THROW(
      full.Write({}, std::vector<float>{0}, std::vector<uint8_t>(4), std::vector<uint8_t>(3)),
      Error);
}

TEST_F(FrameStreamTest, PartsOfAnotherSizeAreABug) {
  FrameStreamWriter writer(file_, Header());
  EXPECT_DEATH(
      writer.Write({}, std::vector<float>{0}, std::vector<uint8_t>(3), std::vector<uint8_t>(3)),
      "3");
}

}  // namespace
}  // namespace shoal::image
