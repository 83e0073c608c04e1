// SPDX-License-Identifier: Apache-2.0
// `shoal film` of a short run from pixels, played by the real programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "common/base/clock.h"
#include "tests/launch/tools/film/decoded_film.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Trained once for all: `shoal train --film` in a small run from pixels.
class Film : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    run_ = new TrainingRun;
    trained_ = new ProgramResult(run_->Train(TrainingRun::FromPixels(), {"--film"}));
  }
  static void TearDownTestSuite() {
    delete trained_;
    delete run_;
  }

  static ProgramResult Run(std::vector<std::string> arguments) {
    std::vector<std::string> command{"shoal", "film"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return RunProgram(command, std::chrono::seconds(120));
  }
  static fs::path Videos() { return run_->path() / "videos"; }

  static inline TrainingRun* run_ = nullptr;
  static inline ProgramResult* trained_ = nullptr;
};

size_t CountFiles(const fs::path& folder) {
  return static_cast<size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST_F(Film, IsMadeAtTheEndOfATraining) {
  ASSERT_EQ(ExitCode(*trained_), 0) << trained_->out << trained_->err;
  EXPECT_THAT(trained_->out, HasSubstr((Videos() / "best.mp4").string()));
  EXPECT_FALSE(launch::DecodeFilm(Videos() / "best.mp4").frames.empty());
}

TEST_F(Film, ShowsOneEpisodeAfterTheOther) {
  const fs::path file = run_->parent() / "film.mp4";
  const ProgramResult result =
      Run({run_->path(), "--episodes", "2", "--seed", "3", "--output", file});
  ASSERT_EQ(ExitCode(result), 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr(file.string()));
  const launch::DecodedFilm film = launch::DecodeFilm(file);
  EXPECT_DOUBLE_EQ(film.frames_per_second, 25);
  // Resets, 50 steps, and half a second at the end of each.
  ASSERT_EQ(film.frames.size(), 2u * (50 + 12));
  for (size_t i = 1; i < 40; ++i) EXPECT_TRUE(film.frames[i] != film.frames[i - 1]) << i;
  EXPECT_LT(fs::file_size(file), 2'000'000u);
}

TEST_F(Film, AcrossCheckpointsIsOneFilm) {
  const ProgramResult result = Run({run_->path(), "--across-checkpoints", "--episodes", "1"});
  ASSERT_EQ(ExitCode(result), 0) << result.err;
  const launch::DecodedFilm film = launch::DecodeFilm(Videos() / "across.mp4");
  EXPECT_GE(film.frames.size(), 62u);
  EXPECT_EQ(film.frames.size() % 62, 0u);
}

TEST_F(Film, WhatCannotBeMadeIsRefusedAndLeavesNothing) {
  const std::string run = run_->path();
  const auto refusal = [&](std::vector<std::string> arguments, int exit_code) {
    const ProgramResult result = Run(std::move(arguments));
    EXPECT_EQ(ExitCode(result), exit_code) << result.err;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    return result.err;
  };
  EXPECT_THAT(refusal({"no-such-run"}, 2), HasSubstr("no run 'no-such-run'"));
  EXPECT_THAT(refusal({run, "--output", "film.avi"}, 2), HasSubstr("film.avi"));
  EXPECT_THAT(refusal({run, "--checkpoint", "step_0"}, 2), HasSubstr("step_0"));
  EXPECT_THAT(refusal({run, "--episodes", "0"}, 2), HasSubstr("--episodes"));
  const fs::path nowhere = run_->parent() / "nowhere";
  EXPECT_THAT(refusal({run, "--output", nowhere / "a.mp4"}, 1), HasSubstr("nowhere/a.mp4"));
  EXPECT_FALSE(fs::exists(nowhere));
}

TEST_F(Film, OneThatIsInterruptedLeavesNothing) {
  const fs::path taken = run_->parent() / "taken";
  fs::create_directories(taken);
  const size_t before = CountFiles(taken);
  const TemporaryFolder folder;
  launch::ProcessSpec spec;
  spec.role = "test";
  spec.command = {ProgramPath("shoal"), "film", run_->path(), "--episodes", "1000", "--output",
                  taken / "film.mp4"};
  spec.output = folder.path() / "out";
  launch::ChildProcess child(spec);
  const SteadyTime deadline = Now() + std::chrono::seconds(60);
  // Its temporary file shows that it is at work.
  while (CountFiles(taken) == before && Now() < deadline && !child.Poll()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ASSERT_EQ(CountFiles(taken), before + 1) << ReadFile(spec.output);
  child.Signal(SIGINT);
  while (!child.Poll() && Now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ASSERT_TRUE(child.Poll());
  EXPECT_EQ(child.Poll()->Describe(), "killed by SIGINT");
  EXPECT_EQ(CountFiles(taken), before);
}

}  // namespace
}  // namespace shoal
