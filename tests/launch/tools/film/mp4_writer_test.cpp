// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/mp4_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/launch/tools/film/decoded_film.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr int kWidth = 64, kHeight = 48;

// Every pixel of one grey.
std::vector<uint8_t> Grey(uint8_t value) {
  return std::vector<uint8_t>(size_t{4} * kWidth * kHeight, value);
}

size_t CountFiles(const fs::path& folder) {
  return size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

class Mp4WriterTest : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const fs::path file_ = folder_.path() / "videos" / "a:b.mp4";
};

TEST_F(Mp4WriterTest, WritesWhatADecoderGetsBack) {
  Mp4Writer writer(file_, kWidth, kHeight, 40'000);
  for (const int value : {20, 120, 220}) writer.Add(Grey(uint8_t(value)), 4 * kWidth);
  EXPECT_FALSE(fs::exists(file_)) << "the file has its name before it is whole";
  writer.Finish();
  const DecodedFilm film = DecodeFilm(file_);
  EXPECT_EQ(film.codec, "h264");
  EXPECT_EQ(film.pixel_format, "yuv420p");
  EXPECT_EQ(film.width, kWidth);
  EXPECT_EQ(film.height, kHeight);
  EXPECT_DOUBLE_EQ(film.frames_per_second, 25);
  ASSERT_EQ(film.frames.size(), 3u);
  // Limited range: 0..255 becomes 16..235.
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(film.frames[i][1000], 16 + (20 + 100 * double(i)) * 219 / 255, 3) << i;
  }
  EXPECT_EQ(CountFiles(file_.parent_path()), 1u);
}

TEST_F(Mp4WriterTest, ItsIndexComesBeforeItsPictures) {
  Mp4Writer writer(file_, kWidth, kHeight, 40'000);
  writer.Add(Grey(9), 4 * kWidth);
  writer.Finish();
  const std::string bytes = ReadFile(file_);
  ASSERT_NE(bytes.find("moov"), std::string::npos);
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

TEST_F(Mp4WriterTest, WhatIsNotFinishedLeavesNothing) {
  {
    Mp4Writer writer(file_, kWidth, kHeight, 40'000);
    writer.Add(Grey(9), 4 * kWidth);
    EXPECT_EQ(CountFiles(file_.parent_path()), 1u);
  }
  EXPECT_FALSE(fs::exists(file_.parent_path())) << "the folder was made for it";
  fs::create_directory(file_.parent_path());
  { Mp4Writer writer(file_, kWidth, kHeight, 40'000); }
  EXPECT_EQ(CountFiles(file_.parent_path()), 0u);
}

TEST_F(Mp4WriterTest, AFormerFilmStaysUntilThereIsANewOne) {
  MakeFolders(file_.parent_path());
  WriteFileAtomically(file_, "former");
  { Mp4Writer writer(file_, kWidth, kHeight, 40'000); }
  EXPECT_EQ(ReadFile(file_), "former");
}

TEST_F(Mp4WriterTest, AFileThatCannotBeWrittenIsNamed) {
  WriteFileAtomically(folder_.path() / "file", "");
  try {
    Mp4Writer writer(folder_.path() / "file" / "a.mp4", kWidth, kHeight, 40'000);
    FAIL() << "wrote into a file as if it were a folder";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr((folder_.path() / "file").string()));
  }
  fs::create_directory(folder_.path() / "taken.mp4");
  Mp4Writer writer(folder_.path() / "taken.mp4", kWidth, kHeight, 40'000);
  writer.Add(Grey(9), 4 * kWidth);
  try {
    writer.Finish();
    FAIL() << "replaced a folder";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("taken.mp4"), HasSubstr("directory")));
  }
}

}  // namespace
}  // namespace shoal::launch
