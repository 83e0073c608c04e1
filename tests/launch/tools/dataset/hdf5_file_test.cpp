// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/dataset/hdf5_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/launch/tools/dataset/read_hdf5.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Hdf5FileTest : public testing::Test {
 protected:
  bool IsEmpty() const { return std::filesystem::is_empty(folder_.path()); }

  TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "data.hdf5";
};

TEST_F(Hdf5FileTest, ArraysAreReadBackAsTheyWereWritten) {
  Hdf5File file(path_);
  file.Write("a/b/floats", {2, 3}, std::vector<float>{1, 2, 3, 4, 5, -6.5f});
  file.Write("a/bytes", {2, 2}, std::vector<uint8_t>{0, 7, 128, 255});
  file.WriteFlags("flags", std::vector<uint8_t>{0, 1, 1});
  file.SetAttribute("a", "count", -12345678901);
  file.Finish();
  const Hdf5Reader reader(path_);
  EXPECT_THAT(reader.Describe("a/b/floats").shape, ElementsAre(2, 3));
  EXPECT_EQ(reader.Describe("a/b/floats").kind, H5T_FLOAT);
  EXPECT_EQ(reader.Describe("a/b/floats").bytes, 4u);
  EXPECT_THAT(reader.Floats("a/b/floats"), ElementsAre(1, 2, 3, 4, 5, -6.5f));
  EXPECT_THAT(reader.Describe("a/bytes").shape, ElementsAre(2, 2));
  EXPECT_EQ(reader.Describe("a/bytes").kind, H5T_INTEGER);
  EXPECT_EQ(reader.Describe("a/bytes").bytes, 1u);
  EXPECT_THAT(reader.Bytes("a/bytes"), ElementsAre(0, 7, 128, 255));
  EXPECT_EQ(reader.Describe("flags").kind, H5T_ENUM);
  EXPECT_EQ(reader.Describe("flags").bytes, 1u);
  EXPECT_THAT(reader.Flags("flags"), ElementsAre("FALSE", "TRUE", "TRUE"));
  EXPECT_EQ(reader.Attribute("a", "count"), -12345678901);
}

TEST_F(Hdf5FileTest, BytesThatRepeatTakeLittleRoom) {
  Hdf5File file(path_);
  file.Write("bytes", {10, 100'000}, std::vector<uint8_t>(1'000'000, 9));
  file.Finish();
  EXPECT_LT(std::filesystem::file_size(path_), 50'000u);
}

TEST_F(Hdf5FileTest, WhatIsNotFinishedLeavesNothing) {
  {
    Hdf5File file(path_);
    file.WriteFlags("flags", std::vector<uint8_t>{1});
    EXPECT_FALSE(std::filesystem::exists(path_));
    EXPECT_FALSE(IsEmpty());
  }
  EXPECT_TRUE(IsEmpty());
}

TEST_F(Hdf5FileTest, AFolderThatIsNotThereIsRefusedInOneLine) {
  const std::filesystem::path path = folder_.path() / "none" / "data.hdf5";
  const std::string refusal = ErrorMessage([&] { Hdf5File file(path); });
  EXPECT_THAT(refusal, HasSubstr("cannot write '" + path.string() + "': No such file"));
}

TEST_F(Hdf5FileTest, ANameTwiceIsRefused) {
  Hdf5File file(path_);
  file.WriteFlags("flags", std::vector<uint8_t>{1});
  const auto again = [&] { file.WriteFlags("flags", std::vector<uint8_t>{1}); };
  EXPECT_THAT(ErrorMessage(again), HasSubstr("exist"));
}

}  // namespace
}  // namespace shoal::launch
