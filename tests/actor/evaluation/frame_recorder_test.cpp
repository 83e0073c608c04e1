// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/frame_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "actor/evaluation/evaluation.h"
#include "actor/evaluation/world_view.h"
#include "common/base/error.h"
#include "tests/support/temporary_folder.h"

namespace shoal::actor {
namespace {

using testing::AllOf;
using testing::ElementsAreArray;
using testing::HasSubstr;

constexpr int kSteps = 3;

class FrameRecorderTest : public testing::Test {
 protected:
  explicit FrameRecorderTest(bool pixels = true) {
    run_.config.task = "FetchReach";
    run_.config.observation.pixels = pixels;
    run_.config.observation.proprioception = !pixels;
    run_.config.observation.height = run_.config.observation.width = 24;
    run_.config.observation.stack = 2;
    std::shared_ptr<worlds::RenderContext> render;
    if (pixels) render = worlds::MakeRenderContext(run_.config.observation);
    auto environment = worlds::MakeEnvironment(run_.config, render);
    run_.spec = environment->spec();
    stack_.resize(size_t(run_.spec.FrameBytes()) * run_.spec.stack);
    policy_vector_.resize(size_t(run_.spec.VectorSize()));
    frame_.resize(size_t(run_.spec.FrameBytes()));
    vector_.resize(size_t(run_.spec.RecordedVectorSize()));
    runner_.emplace(std::move(environment), EpisodeRunner::PolicyInput{stack_, policy_vector_});
  }

  FrameRecorder::Options Options(const std::string& camera = "") const {
    return {.file = file_, .camera = camera, .height = 40, .width = 60, .quality = "fast"};
  }
  // Plays a few steps of two episodes; returns the policy's input after each record.
  std::vector<std::vector<uint8_t>> Record(const FrameRecorder::Options& options) {
    FrameRecorder recorder(run_.spec, options.file, MakeWorldView(run_, options));
    runner_->set_listener(&recorder);
    std::vector<std::vector<uint8_t>> inputs;
    runner_->Begin(11, {frame_, vector_});
    inputs.push_back(stack_);
    for (int step = 0; step < kSteps; ++step) {
      runner_->Step(std::vector<float>{1, -0.5F, 0.25F, 0}, {frame_, vector_});
      inputs.push_back(stack_);
    }
    runner_->set_listener(nullptr);
    return inputs;
  }
  std::vector<image::ShownFrame> Read() const {
    image::FrameStreamReader reader(file_);
    EXPECT_EQ(reader.header().view_height, 40u);
    EXPECT_EQ(reader.header().view_width, 60u);
    EXPECT_EQ(reader.header().step_microseconds, 40'000u) << "Fetch is controlled at 25 Hz";
    std::vector<image::ShownFrame> frames;
    while (auto frame = reader.Next()) frames.push_back(std::move(*frame));
    return frames;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "frames";
  RunConfig run_;
  std::vector<uint8_t> stack_, frame_;
  std::vector<float> policy_vector_, vector_;
  std::optional<EpisodeRunner> runner_;
};

TEST_F(FrameRecorderTest, HoldsThePolicysInputsAndALargerViewOfTheSameEpisode) {
  const auto inputs = Record(Options());
  const auto frames = Read();
  ASSERT_EQ(frames.size(), 1u + kSteps);
  for (size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].record.episode, 0u);
    EXPECT_EQ(frames[i].record.step, i);
    EXPECT_EQ(frames[i].input, inputs[i]) << i;
    if (i == 0) continue;  // a reset has no action
    EXPECT_THAT(frames[i].action, ElementsAreArray({1.0F, -0.5F, 0.25F, 0.0F}));
  }
  EXPECT_EQ(frames[1].record.reward, -1) << "the task is sparse";
  EXPECT_NE(frames[0].view, frames[kSteps].view) << "the arm has moved";

  // The view is the camera's picture of the same moment: what an environment of that size renders.
  Config config = run_.config;
  config.observation.cameras = {run_.config.observation.cameras.front()};
  config.observation.height = 40;
  config.observation.width = 60;
  const auto same = worlds::MakeEnvironment(config, worlds::MakeRenderContext(config.observation));
  std::vector<uint8_t> planes(size_t{3} * 40 * 60);
  std::vector<float> vector(size_t(same->spec().RecordedVectorSize()));
  same->Reset(11, {planes, vector});
  for (size_t pixel = 0; pixel < size_t{40} * 60; ++pixel) {
    for (size_t channel = 0; channel < 3; ++channel) {
      ASSERT_EQ(frames[0].view[3 * pixel + channel], planes[channel * 40 * 60 + pixel]) << pixel;
    }
  }
}

// A run in quality native needs no OSMesa, nor does its film.
TEST_F(FrameRecorderTest, TheViewIsNativeWhereTheRunIs) {
  const auto view_of = [this](const std::string& run_quality, const std::string& quality) {
    run_.config.observation.quality = run_quality;
    FrameRecorder::Options options = Options();
    options.quality = quality;
    Record(options);
    return Read().front().view;
  };
  EXPECT_EQ(view_of("native", ""), view_of("fast", "native"));
  EXPECT_EQ(view_of("fast", ""), view_of("native", "reference"));
  EXPECT_NE(view_of("native", ""), view_of("fast", ""));
}

// Set-up of a film: the evaluation's own runner, and the view beside it.
TEST_F(FrameRecorderTest, WithHindsightTheViewAloneShowsTheGoal) {
  for (const bool hindsight : {false, true}) {
    RunConfig run = run_;
    run.config.observation.goal_mode = "desired";
    run.config.observation.height = run.config.observation.width = 48;
    run.config.replay.hindsight = hindsight ? "future" : "none";
    run.config.eval.envs = 1;
    run.config.network.hidden = {8};
    run.spec =
        worlds::MakeEnvironment(run.config, worlds::MakeRenderContext(run.config.observation))
            ->spec();
    Evaluator evaluator(run, /*noop=*/true);
    {
      FrameRecorder recorder(run.spec, Options().file, MakeWorldView(run, Options()));
      evaluator.Listen(&recorder);
      int asked = 0;  // before each step: no more than the second episode's first one
      evaluator.Play(2, {7, StreamRole::kFinalEnvironment, 0}, [&] { return asked++ == 51; });
      evaluator.Listen(nullptr);
    }
    std::vector<image::ShownFrame> first;
    for (image::ShownFrame& frame : Read()) {
      if (frame.record.step == 0) first.push_back(std::move(frame));
    }
    ASSERT_EQ(first.size(), 2u);
    EXPECT_NE(first[0].view, first[1].view) << "the goals are two";
    EXPECT_EQ(first[0].input == first[1].input, hindsight);
  }
}

TEST_F(FrameRecorderTest, TheViewsCameraIsChosen) {
  Record(Options());
  const auto first = Read();
  Record(Options("side"));
  const auto side = Read();
  EXPECT_EQ(side[1].input, first[1].input);
  EXPECT_NE(side[1].view, first[1].view);
}

TEST_F(FrameRecorderTest, ACameraThatIsNotThereIsRefusedNamingThoseThatAre) {
  try {
    Record(Options("sied"));
    FAIL() << "recorded a camera that does not exist";
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 2);
    EXPECT_THAT(e.what(), AllOf(HasSubstr("'sied'"), HasSubstr("side")));
  }
}

class StateFrameRecorderTest : public FrameRecorderTest {
 protected:
  StateFrameRecorderTest() : FrameRecorderTest(/*pixels=*/false) {}
};

TEST_F(StateFrameRecorderTest, APolicyWithoutPixelsIsShownFromTheTasksOwnCamera) {
  Record(Options());
  const auto frames = Read();
  ASSERT_EQ(frames.size(), 1u + kSteps);
  EXPECT_TRUE(frames[0].input.empty());
  EXPECT_GT(*std::ranges::max_element(frames[0].view), 50) << "it is black";
  EXPECT_NE(frames[0].view, frames[kSteps].view);
}

}  // namespace
}  // namespace shoal::actor
