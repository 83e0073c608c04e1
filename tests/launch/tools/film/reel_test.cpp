// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/reel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/launch/tools/film/decoded_film.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using image::FrameRecordHeader;
using testing::AllOf;
using testing::HasSubstr;

class FilmReelTest : public testing::Test {
 protected:
  FilmReelTest() {
    spec_.task = "Task";
    spec_.cameras = {"front"};
    spec_.channels = 3;
    spec_.height = spec_.width = 4;
    spec_.action_size = 2;
  }

  image::FrameStreamHeader Header(uint32_t step_microseconds = 40'000) const {
    return {.magic = {},
            .channels = 3,
            .height = 4,
            .width = 4,
            .frame_channels = 3,
            .view_height = kFilmView,
            .view_width = kFilmView,
            .action_size = 2,
            .step_microseconds = step_microseconds};
  }
  void WriteStream(const image::FrameStreamHeader& header,
                   const std::vector<FrameRecordHeader>& records) const {
    image::FrameStreamWriter writer(stream_, header);
    const std::vector<float> action(header.action_size);
    const std::vector<uint8_t> input(header.InputBytes(), 50), view(header.ViewBytes(), 60);
    for (const FrameRecordHeader& record : records) writer.Write(record, action, input, view);
  }
  // The error of a film for the stream in stream_.
  std::string Refusal(uint32_t episodes = 1) const {
    try {
      FilmReel reel(spec_, film_);
      reel.Add(stream_, "best", episodes);
    } catch (const Error& e) {
      EXPECT_FALSE(fs::exists(film_.parent_path())) << "something is left";
      return e.what();
    }
    return "filmed";
  }
  std::string RefusalOf(const std::vector<FrameRecordHeader>& records,
                        uint32_t episodes = 1) const {
    WriteStream(Header(), records);
    return Refusal(episodes);
  }
  // Episode `episode` of `steps` steps.
  static std::vector<FrameRecordHeader> Episode(uint32_t episode, uint32_t steps) {
    std::vector<FrameRecordHeader> records;
    for (uint32_t step = 0; step <= steps; ++step) {
      const uint32_t flags = step == steps ? image::kShownEnd | image::kShownSuccess : 0U;
      records.push_back({episode, step, -0.25F * float(step), flags});
    }
    return records;
  }

  const TemporaryFolder folder_;
  const fs::path stream_ = folder_.path() / "frames", film_ = folder_.path() / "videos/film.mp4";
  ObservationSpec spec_;
};

TEST_F(FilmReelTest, ShowsEveryStepOfEveryStreamAndHoldsTheLast) {
  FilmReel reel(spec_, film_);
  for (const char* checkpoint : {"step_000000001", "best"}) {
    auto records = Episode(0, 3);
    for (const FrameRecordHeader& record : Episode(1, 2)) records.push_back(record);
    WriteStream(Header(), records);
    reel.Add(stream_, checkpoint, 2);
  }
  EXPECT_FALSE(fs::exists(film_));
  reel.Finish();
  const DecodedFilm film = DecodeFilm(film_);
  // Half a second of each episode's last picture: 12 of 25 a second.
  ASSERT_EQ(film.frames.size(), 2u * (3 + 12 + 2 + 12));
  EXPECT_EQ(reel.frames(), film.frames.size());
  EXPECT_DOUBLE_EQ(film.frames_per_second, 25);
  EXPECT_NEAR(reel.seconds(), double(film.frames.size()) / 25, 1e-9);
  for (const size_t i : {0, 1, 2, 3}) EXPECT_TRUE(film.frames[i] != film.frames[i + 1]) << i;
}

TEST_F(FilmReelTest, PlaysAsFastAsTheWorldAndAtMostFiftyPicturesASecond) {
  WriteStream(Header(8000), Episode(0, 10));  // 125 steps a second
  FilmReel reel(spec_, film_);
  reel.Add(stream_, "best", 1);
  reel.Finish();
  // Steps 0, 3, 6, 9 and the last, which stays for half a second: 20 times 24 ms.
  EXPECT_EQ(reel.frames(), 4u + 20u);
  EXPECT_NEAR(DecodeFilm(film_).frames_per_second, 1 / 0.024, 1e-6);
}

TEST_F(FilmReelTest, AStreamThatDoesNotSayItsRateHas25PicturesASecond) {
  WriteStream(Header(0), Episode(0, 1));
  FilmReel reel(spec_, film_);
  reel.Add(stream_, "best", 1);
  reel.Finish();
  EXPECT_DOUBLE_EQ(DecodeFilm(film_).frames_per_second, 25);
}

TEST_F(FilmReelTest, AStreamThatEndsEarlyIsRefused) {
  const auto whole = Episode(0, 2);
  EXPECT_EQ(RefusalOf(whole), "filmed");
  EXPECT_THAT(RefusalOf({}), HasSubstr("ends before step 0 of episode 0 of 1"));
  EXPECT_THAT(RefusalOf({whole[0], whole[1]}), HasSubstr("ends before step 2"));
  EXPECT_THAT(RefusalOf(whole, 2), HasSubstr("ends before step 0 of episode 1 of 2"));
  WriteStream(Header(), whole);
  const std::string bytes = ReadFile(stream_);
  std::ofstream(stream_, std::ios::binary) << bytes.substr(0, bytes.size() - 1);
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("frames'"), HasSubstr("the last frame")));
  std::ofstream(stream_, std::ios::binary) << "no stream";
  EXPECT_THAT(Refusal(), HasSubstr("not a stream of frames"));
}

TEST_F(FilmReelTest, StepsThatAreMissingOrNoNumbersAreRefused) {
  auto records = Episode(0, 3);
  EXPECT_THAT(RefusalOf({records[0], records[2]}), HasSubstr("step 2 of episode 0 where step 1"));
  EXPECT_THAT(RefusalOf({records[1]}), HasSubstr("step 1 of episode 0 where step 0"));
  EXPECT_THAT(RefusalOf(Episode(1, 2)), HasSubstr("step 0 of episode 1 where step 0 of episode 0"));
  auto more = Episode(0, 1);
  for (const FrameRecordHeader& record : Episode(1, 1)) more.push_back(record);
  EXPECT_THAT(RefusalOf(more), HasSubstr("of episode 1 where step 0 of episode 1 of 1"));
  records[1].reward = NAN;
  EXPECT_THAT(RefusalOf(records), HasSubstr("reward of step 1"));
}

TEST_F(FilmReelTest, StreamsOfOtherSizesAreRefused) {
  const auto refusal = [&](const image::FrameStreamHeader& header) {
    WriteStream(header, {});
    return Refusal();
  };
  for (const auto change : {+[](image::FrameStreamHeader& h) { h.height = 5; },
                            +[](image::FrameStreamHeader& h) { h.width = 5; },
                            +[](image::FrameStreamHeader& h) { h.channels = 6; },
                            +[](image::FrameStreamHeader& h) { h.frame_channels = 1; },
                            +[](image::FrameStreamHeader& h) { h.view_width = 480; },
                            +[](image::FrameStreamHeader& h) { h.view_height = 480; },
                            +[](image::FrameStreamHeader& h) { h.action_size = 4; }}) {
    image::FrameStreamHeader header = Header();
    change(header);
    EXPECT_THAT(refusal(header), HasSubstr("expected 3 x 4 x 4, 560 x 560 and 2"));
  }
  EXPECT_THAT(refusal(Header(10'000'001)), HasSubstr("no task's"));
}

}  // namespace
}  // namespace shoal::launch
