// SPDX-License-Identifier: Apache-2.0
#include "common/tensorboard/event_writer.h"

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/tensorboard/event.pb.h"

namespace shoal::tensorboard {
namespace {

namespace fs = std::filesystem;

class EventWriterTest : public testing::Test {
 protected:
  EventWriterTest()
      : folder_(fs::path(testing::TempDir()) /
                ("event_writer_" + std::to_string(getpid()) + "_" +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
  }
  ~EventWriterTest() override { fs::remove_all(folder_); }

  fs::path folder_;
};

// Payloads of a well-framed file; the checksums are tf_record_test's matter.
std::vector<std::string> Payloads(const std::string& file) {
  std::vector<std::string> payloads;
  size_t at = 0;
  while (at < file.size()) {
    uint64_t length = 0;
    std::memcpy(&length, file.data() + at, 8);
    EXPECT_LE(at + 16 + length, file.size());
    payloads.push_back(file.substr(at + 12, length));
    at += 16 + length;
  }
  return payloads;
}

// An event after its 9 bytes of wall time: tag byte 0x09 and a little-endian double.
std::string AfterWallTime(const std::string& payload) {
  EXPECT_EQ(payload.at(0), '\x09');
  return payload.substr(9);
}

TEST_F(EventWriterTest, BeginsWithTheVersionEvent) {
  EventWriter writer(folder_);
  writer.Flush();
  const auto payloads = Payloads(ReadFile(writer.path()));
  ASSERT_EQ(payloads.size(), 1u);
  // Field 3, length 13.
  EXPECT_EQ(AfterWallTime(payloads[0]),
            "\x1a\x0d"
            "brain.Event:2");
}

TEST_F(EventWriterTest, WritesAScalarInGoldenBytes) {
  EventWriter writer(folder_);
  writer.Scalar("a/b", 300, 1.5);
  writer.Flush();
  const auto payloads = Payloads(ReadFile(writer.path()));
  ASSERT_EQ(payloads.size(), 2u);
  const char golden[] =
      "\x10\xac\x02"  // field 2: step 300
      "\x2a\x0c"      // field 5: summary, 12 bytes
      "\x0a\x0a"      // field 1: value, 10 bytes
      "\x0a\x03"
      "a/b"                // field 1: tag
      "\x15\0\0\xc0\x3f";  // field 2: float 1.5
  EXPECT_EQ(AfterWallTime(payloads[1]), std::string(golden, sizeof golden - 1));
}

TEST_F(EventWriterTest, NamesTheFileAsTensorBoardExpects) {
  EventWriter first(folder_), second(folder_);
  EXPECT_NE(first.path(), second.path());
  const std::string name = first.path().filename();
  EXPECT_EQ(name.rfind("events.out.tfevents.", 0), 0u) << name;
  EXPECT_EQ(name.find_first_not_of("0123456789", 20), 30u) << "ten digits of seconds: " << name;
  EXPECT_NE(name.find(fmt::format(".{}.", getpid())), std::string::npos) << name;
}

TEST_F(EventWriterTest, KeepsEveryPointWithoutAFlush) {
  fs::path path;
  {
    EventWriter writer(folder_);
    path = writer.path();
    for (int i = 0; i < 5000; ++i) writer.Scalar("train/critic_loss", i, i * 0.5);
  }
  const auto payloads = Payloads(ReadFile(path));
  ASSERT_EQ(payloads.size(), 5001u);
  proto::Event last;
  ASSERT_TRUE(last.ParseFromString(payloads.back()));
  EXPECT_EQ(last.step(), 4999);
  EXPECT_EQ(last.summary().value(0).simple_value(), 2499.5f);
  EXPECT_GT(last.wall_time(), 1.5e9);
}

TEST_F(EventWriterTest, NamesAFolderThatCannotBeMade) {
  WriteFileAtomically(folder_, "a file where the folder should be");
  try {
    EventWriter writer(folder_);
    FAIL() << "made a file in a file";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find(folder_.string()), std::string::npos) << e.what();
  }
}

TEST_F(EventWriterTest, AnImageIsItsSizeAndItsFilesBytes) {
  EventWriter writer(folder_);
  writer.Image("film/episode", 7, 20, 10, "png bytes");
  writer.Flush();
  proto::Event event;
  ASSERT_TRUE(event.ParseFromString(Payloads(ReadFile(writer.path())).at(1)));
  EXPECT_EQ(event.step(), 7);
  const proto::Summary::Value& value = event.summary().value(0);
  EXPECT_EQ(value.tag(), "film/episode");
  EXPECT_EQ(value.image().width(), 20);
  EXPECT_EQ(value.image().height(), 10);
  EXPECT_EQ(value.image().colorspace(), 3);
  EXPECT_EQ(value.image().encoded_image_string(), "png bytes");
}

}  // namespace
}  // namespace shoal::tensorboard
