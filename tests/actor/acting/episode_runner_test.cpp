// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/episode_runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/actor/counting_environment.h"

namespace shoal::actor {
namespace {

using testing::Each;
using testing::ElementsAre;

class EpisodeRunnerTest : public testing::Test {
 protected:
  static constexpr size_t kFrame = 32;

  float Begin(uint64_t key) { return runner_.Begin(key, {frame_, vector_}); }
  worlds::StepResult Step(float first, float second) {
    return runner_.Step(std::vector<float>{first, second}, {frame_, vector_});
  }
  // The byte that fills the i-th frame of the policy's stack.
  int StackByte(size_t i) const {
    EXPECT_THAT(std::span(stack_).subspan(i * kFrame, kFrame), Each(stack_[i * kFrame]));
    return stack_[i * kFrame];
  }

  std::vector<uint8_t> stack_ = std::vector<uint8_t>(2 * kFrame),
                       frame_ = std::vector<uint8_t>(kFrame);
  std::vector<float> policy_vector_ = std::vector<float>(2), vector_ = std::vector<float>(2);
  EpisodeRunner runner_{std::make_unique<CountingEnvironment>(), {stack_, policy_vector_}};
};

TEST_F(EpisodeRunnerTest, ThePolicyReadsTheStackAndTheNewestVector) {
  EXPECT_FALSE(runner_.running());
  EXPECT_EQ(Begin(4), 100);
  EXPECT_TRUE(runner_.running());
  EXPECT_EQ(StackByte(0), 40);
  EXPECT_EQ(StackByte(1), 40) << "the first frame is repeated";
  EXPECT_THAT(policy_vector_, ElementsAre(4, 0));
  Step(0, 0);
  EXPECT_EQ(StackByte(0), 40);
  EXPECT_EQ(StackByte(1), 41);
  EXPECT_THAT(policy_vector_, ElementsAre(4, 1));
  EXPECT_THAT(frame_, Each(41)) << "what is recorded is the newest frame alone";
  EXPECT_EQ(vector_, policy_vector_);
}

TEST_F(EpisodeRunnerTest, FiguresAreOfTheWholeEpisodeAndStartAnew) {
  Begin(4);
  Step(0, 0);
  Step(0.25F, 0);
  EXPECT_EQ(runner_.figures().length, 2);
  const worlds::StepResult last = Step(0.75F, 0.5F);
  EXPECT_TRUE(last.terminated);
  EXPECT_FALSE(runner_.running());
  const EpisodeFigures& figures = runner_.figures();
  EXPECT_EQ(figures.length, 3);
  EXPECT_EQ(figures.episode_return, 1);
  EXPECT_TRUE(figures.success);
  EXPECT_EQ(figures.final_distance, 97);
  EXPECT_NEAR(figures.action_smoothness, (0.25 + std::sqrt(0.5)) / 2, 1e-12)
      << "a mean over the two changes";
  ASSERT_EQ(figures.drawn_masses.size(), 1u);
  EXPECT_EQ(figures.drawn_masses[0].mass_kg, 4);

  Begin(7);
  EXPECT_EQ(runner_.figures().length, 0);
  EXPECT_EQ(runner_.figures().episode_return, 0);
  EXPECT_EQ(runner_.figures().drawn_masses[0].mass_kg, 7);
  EXPECT_EQ(StackByte(0), 70) << "no frame of the episode before";
  Step(0.75F, 0);
  Step(0.75F, 0);
  EXPECT_FALSE(runner_.figures().success) << "success is that of the end";
  const worlds::StepResult end = Step(0.5F, 0);
  EXPECT_TRUE(end.truncated);
  EXPECT_FALSE(runner_.running());
  EXPECT_FALSE(runner_.figures().success);
  EXPECT_NEAR(runner_.figures().action_smoothness, 0.125, 1e-12)
      << "the change from the episode before is none";
}

TEST_F(EpisodeRunnerTest, AnEpisodeIsCutAsByATimeLimit) {
  runner_.Begin(4, {frame_, vector_}, /*cut_after=*/2);
  EXPECT_FALSE(Step(0, 0).truncated);
  const worlds::StepResult cut = Step(0.25F, 0);
  EXPECT_TRUE(cut.truncated);
  EXPECT_FALSE(cut.terminated);
  EXPECT_FALSE(runner_.running());
  EXPECT_EQ(runner_.figures().final_distance, 98);
  EXPECT_THAT(vector_, ElementsAre(4, 2)) << "observed after its last step";

  runner_.Begin(4, {frame_, vector_}, /*cut_after=*/3);
  Step(0, 0);
  Step(0, 0);
  const worlds::StepResult end = Step(0, 0);
  EXPECT_TRUE(end.terminated);
  EXPECT_FALSE(end.truncated) << "the task's own end comes first";

  Begin(5);
  Step(0, 0);
  EXPECT_FALSE(Step(0, 0).truncated) << "a cut is of its episode alone";
}

TEST_F(EpisodeRunnerTest, AnAbandonedEpisodeNoLongerRuns) {
  Begin(4);
  runner_.Abandon();
  EXPECT_FALSE(runner_.running());
  Begin(5);
  EXPECT_TRUE(runner_.running());
}

TEST(FaultyRunner, TheEpisodeEndsAtTheObservationBefore) {
  constexpr size_t kFrame = 32;
  struct Listener : EpisodeListener {
    void OnBegin(uint64_t, std::span<const uint8_t>) override { ++begun; }
    void OnStep(const SeenStep&) override { ++steps; }
    void OnFault(std::span<const uint8_t> stack) override { shown.push_back(stack.back()); }
    int begun = 0, steps = 0;
    std::vector<int> shown;
  };
  auto environment = std::make_unique<CountingEnvironment>();
  environment->faulty = [](uint64_t key, int step) {
    return key == 4 ? step == 3 : key == 5 && step == 0;
  };
  std::vector<uint8_t> stack(2 * kFrame), frame(kFrame);
  std::vector<float> policy_vector(2), vector(2);
  EpisodeRunner runner(std::move(environment), {stack, policy_vector});
  Listener listener;
  runner.set_listener(&listener);
  runner.Begin(4, {frame, vector});
  const std::vector<float> action{0.75F, 0};
  runner.Step(action, {frame, vector});
  runner.Step(action, {frame, vector});
  const std::vector<uint8_t> stack_before = stack;
  const std::vector<float> vector_before = vector;
  EXPECT_THROW(runner.Step(action, {frame, vector}), worlds::EpisodeFault);
  EXPECT_FALSE(runner.running());
  EXPECT_EQ(stack, stack_before);
  EXPECT_EQ(vector, vector_before);
  EXPECT_EQ(policy_vector, vector_before);
  EXPECT_EQ(runner.figures().length, 2);
  EXPECT_EQ(runner.figures().episode_return, 1.5);
  EXPECT_EQ(runner.figures().final_distance, 98);
  EXPECT_FALSE(runner.figures().success) << "the last step's counts for nothing";
  EXPECT_THAT(listener.shown, ElementsAre(42)) << "the second step's frame";
  EXPECT_THROW(runner.Begin(5, {frame, vector}), worlds::EpisodeFault);
  EXPECT_FALSE(runner.running());
  EXPECT_EQ(runner.figures().length, 0);
  EXPECT_EQ(listener.begun, 1);
  EXPECT_EQ(listener.steps, 2);
  EXPECT_EQ(listener.shown.size(), 2u);
  runner.Begin(6, {frame, vector});
  EXPECT_TRUE(runner.running()) << "the next episode is as any other";
}

struct Recorder : EpisodeListener {
  void OnBegin(uint64_t stream_key, std::span<const uint8_t> stack) override {
    keys.push_back(stream_key);
    bytes.push_back(stack.back());
  }
  void OnStep(const SeenStep& step) override {
    bytes.push_back(step.stack.back());
    oldest.push_back(step.stack.front());
    first_actions.push_back(step.action[0]);
    rewards.push_back(step.reward);
    successes.push_back(step.success);
    ends.push_back(step.ended);
  }
  void OnFault(std::span<const uint8_t>) override { FAIL() << "no fault"; }
  std::vector<uint64_t> keys;
  std::vector<int> bytes, oldest;
  std::vector<float> first_actions, rewards;
  std::vector<bool> successes, ends;
};

TEST_F(EpisodeRunnerTest, AListenerSeesWhatThePolicySeesAndDoes) {
  Begin(1);
  Recorder recorder;
  runner_.set_listener(&recorder);
  Begin(4);
  Step(0.25F, 0);
  Step(0.75F, 0);
  Step(0.5F, 0);
  runner_.set_listener(nullptr);
  Begin(5);
  EXPECT_THAT(recorder.keys, ElementsAre(4));
  EXPECT_THAT(recorder.bytes, ElementsAre(40, 41, 42, 43)) << "after each step, the newest last";
  EXPECT_THAT(recorder.oldest, ElementsAre(40, 41, 42));
  EXPECT_THAT(recorder.first_actions, ElementsAre(0.25F, 0.75F, 0.5F));
  EXPECT_THAT(recorder.rewards, ElementsAre(0.25F, 0.75F, 0.5F));
  EXPECT_THAT(recorder.successes, ElementsAre(false, true, false));
  EXPECT_THAT(recorder.ends, ElementsAre(false, false, true));
}

using EpisodeRunnerDeathTest = EpisodeRunnerTest;

TEST_F(EpisodeRunnerDeathTest, NoStepWithoutAnEpisode) {
  EXPECT_DEATH(Step(0, 0), "without an episode");
}

TEST_F(EpisodeRunnerDeathTest, AnInputOfAnotherSizeIsABug) {
  EXPECT_DEATH(EpisodeRunner(std::make_unique<CountingEnvironment>(/*length=*/3, /*stack=*/3),
                             {stack_, vector_}),
               "64");
}

}  // namespace
}  // namespace shoal::actor
