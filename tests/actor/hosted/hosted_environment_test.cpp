// SPDX-License-Identifier: Apache-2.0
#include "actor/hosted/hosted_environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "actor/hosted/hosted_spec.h"
#include "actor/worlds/episode_fault.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/wire/scoped_seconds.h"
#include "tests/support/error_message.h"

namespace shoal::hosted {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// The next observation and step of a fake environment.
struct Script {
  std::vector<double> state{1, 2};
  std::vector<float> arm{3};
  std::vector<uint8_t> image = std::vector<uint8_t>(size_t{8} * 8 * 3, 7);
  RawStep step{.reward = 0.5};
  std::vector<uint32_t> seeds;
  std::vector<std::vector<double>> actions;
  double call_seconds = 0;      // that a reset and a step take at least
  double reading_seconds = 0;   // ... that it takes to read the arrays
  double binding_seconds = 0;   // of the calls, as it says
  double called = 0, read = 0;  // seconds that calls and reading took
};

void Spin(double seconds, double& total) {
  const ScopedSeconds timed(total);
  const SteadyTime start = Now();
  while (SecondsSince(start) < seconds) {
  }
}

class FakeRaw final : public RawEnvironment {
 public:
  FakeRaw(Script& script, bool image) : script_(script), image_(image) {}
  void Reset(uint32_t seed) override {
    script_.seeds.push_back(seed);
    Spin(script_.call_seconds, script_.called);
    Show();
  }
  RawStep Step(std::span<const double> action) override {
    script_.actions.emplace_back(action.begin(), action.end());
    Spin(script_.call_seconds, script_.called);
    Show();
    return script_.step;
  }
  std::span<const void* const> observation() const override {
    Spin(script_.reading_seconds, script_.read);
    return arrays_;
  }
  double binding_seconds() const override { return script_.binding_seconds; }
  RawPicture Render() override { return {}; }

 private:
  void Show() {
    arrays_ = {script_.state.data(), script_.arm.data()};
    if (image_) arrays_.push_back(script_.image.data());
  }

  Script& script_;
  const bool image_;
  std::vector<const void*> arrays_;
};

tasks::EnvironmentDescription Description(bool image = false) {
  tasks::EnvironmentDescription description{
      .id = "Fake-v0",
      .task = "Fake-v0",
      .episode_steps = 50,
      .action = {.name = "action", .shape = {2}, .low = {-2, 0}, .high = {2, 10}},
      .observation =
          {{.name = "state",
            .shape = {2},
            .type = tasks::ElementType::kFloat64,
            .low = {-5},
            .high = {5}},
           {.name = "robot.arm", .shape = {1}, .low = {-kInfinite}, .high = {kInfinite}}},
      .success = true};
  if (image) {
    description.observation.push_back({.name = "camera",
                                       .shape = {8, 8, 3},
                                       .type = tasks::ElementType::kUint8,
                                       .low = {0},
                                       .high = {255}});
  }
  return description;
}

Config StateConfig() {
  Config config;
  config.env.id = "Fake-v0";
  config.observation.pixels = false;
  config.observation.proprioception = true;
  return config;
}

class HostedEnvironmentTest : public testing::Test {
 protected:
  HostedEnvironment Make(const Config& config, bool image = false) {
    return {Description(image), config, std::make_unique<FakeRaw>(script_, image)};
  }
  // A step of zeros; `vector` keeps the observation.
  worlds::StepResult Step(HostedEnvironment& environment, std::vector<float> action = {0, 0}) {
    vector_.resize(size_t(environment.spec().RecordedVectorSize()));
    frame_.resize(size_t(environment.spec().FrameBytes()));
    return environment.Step(action, {frame_, vector_});
  }
  void Reset(HostedEnvironment& environment, uint64_t key = 0) {
    vector_.resize(size_t(environment.spec().RecordedVectorSize()));
    frame_.resize(size_t(environment.spec().FrameBytes()));
    environment.Reset(key, {frame_, vector_});
  }

  Script script_;
  std::vector<float> vector_;
  std::vector<uint8_t> frame_;
};

TEST_F(HostedEnvironmentTest, MapsActionsToTheEnvironmentsBounds) {
  HostedEnvironment environment = Make(StateConfig());
  Reset(environment);
  Step(environment, {-1, -1});
  Step(environment, {1, 1});
  Step(environment, {0.5F, -0.5F});
  EXPECT_THAT(script_.actions[0], ElementsAre(-2, 0));
  EXPECT_THAT(script_.actions[1], ElementsAre(2, 10));
  EXPECT_THAT(script_.actions[2], ElementsAre(1, 2.5));
}

TEST_F(HostedEnvironmentTest, ObservesEveryArrayInTheOrderOfTheSpaces) {
  HostedEnvironment environment = Make(StateConfig());
  EXPECT_EQ(environment.spec().blocks,
            (std::vector<BlockSpec>{{"state", 2, true}, {"robot.arm", 1, true}}));
  Reset(environment);
  EXPECT_THAT(vector_, ElementsAre(1, 2, 3));
  script_.arm = {-4};
  const worlds::StepResult result = Step(environment);
  EXPECT_THAT(vector_, ElementsAre(1, 2, -4));
  EXPECT_EQ(result.reward, 0.5F);
  EXPECT_TRUE(std::isnan(result.distance));
}

TEST_F(HostedEnvironmentTest, SeedsFollowFromTheStreamKeyAlone) {
  HostedEnvironment environment = Make(StateConfig());
  Reset(environment, 0x8000000100000000U);
  Reset(environment, 5);
  Reset(environment, 0x8000000100000000U);
  EXPECT_EQ(script_.seeds[0], script_.seeds[2]);
  EXPECT_NE(script_.seeds[0], script_.seeds[1]);
  for (const uint32_t seed : script_.seeds)
    EXPECT_LT(seed, 1U << 31) << "some generators take less";
}

TEST_F(HostedEnvironmentTest, EndsAreTheEnvironmentsOwn) {
  HostedEnvironment environment = Make(StateConfig());
  Reset(environment);
  script_.step = {.reward = 1, .truncated = true};
  EXPECT_TRUE(Step(environment).truncated);
  script_.step = {.reward = 1, .terminated = true, .truncated = true, .success = true};
  const worlds::StepResult both = Step(environment);
  EXPECT_TRUE(both.terminated && !both.truncated) << "nothing is expected after it";
  EXPECT_TRUE(both.success);
}

TEST_F(HostedEnvironmentTest, AnEpisodeMayEndWithItsSuccess) {
  Config config = StateConfig();
  config.end_on_success = true;
  HostedEnvironment environment = Make(config);
  Reset(environment);
  script_.step = {.success = false};
  EXPECT_FALSE(Step(environment).terminated);
  script_.step = {.success = true};
  EXPECT_TRUE(Step(environment).terminated);
}

TEST_F(HostedEnvironmentTest, RepeatedActionsAddTheirRewards) {
  Config config = StateConfig();
  config.action_repeat = 3;
  HostedEnvironment environment = Make(config);
  Reset(environment);
  EXPECT_EQ(Step(environment).reward, 1.5F);
  EXPECT_EQ(script_.actions.size(), 3u);
  script_.step.terminated = true;
  EXPECT_EQ(Step(environment).reward, 0.5F) << "the episode has ended";
}

// Four calls of the user's code: a reset and three control steps. The arrays are read twice.
TEST_F(HostedEnvironmentTest, TimeOfTheUsersCodeLeavesOutConversion) {
  Config config = StateConfig();
  config.action_repeat = 3;
  HostedEnvironment environment = Make(config);
  script_.call_seconds = 0.002;
  script_.reading_seconds = 0.01;
  const SteadyTime start = Now();
  Reset(environment);
  Step(environment);
  const double all = SecondsSince(start);
  const double users = environment.user_seconds().value();
  EXPECT_GE(script_.called, 4 * 0.002);
  EXPECT_GE(script_.read, 2 * 0.01);
  EXPECT_GE(users, script_.called);
  EXPECT_LE(users, all - script_.read);
  script_.binding_seconds = 0.001;
  EXPECT_DOUBLE_EQ(environment.user_seconds().value(), users - 0.001);
}

TEST_F(HostedEnvironmentTest, ANumberThatIsNotFiniteIsAFaultOfTheEpisode) {
  HostedEnvironment environment = Make(StateConfig());
  Reset(environment);
  const std::vector<float> before = vector_;
  script_.arm = {std::nanf("")};
  try {
    Step(environment);
    FAIL() << "a NaN was recorded";
  } catch (const worlds::EpisodeFault& fault) {
    EXPECT_EQ(fault.cause(), worlds::FaultCause::kObservation);
    EXPECT_THAT(fault.what(), AllOf(HasSubstr("Fake-v0"), HasSubstr("'robot.arm'")));
  }
  EXPECT_EQ(vector_, before) << "what was observed before stays";
  script_.arm = {1};
  script_.step.reward = 1e300;  // beyond float32
  EXPECT_THROW(Step(environment), worlds::EpisodeFault);
}

TEST_F(HostedEnvironmentTest, NumbersBeyondTheirBoundsPass) {
  HostedEnvironment environment = Make(StateConfig());
  script_.state = {5.1, 0};
  Reset(environment);
  EXPECT_THAT(vector_, ElementsAre(5.1F, 0, 3));
}

TEST_F(HostedEnvironmentTest, ImagesBecomeFrames) {
  Config config;
  config.env.id = "Fake-v0";
  config.observation.height = config.observation.width = 16;
  config.observation.proprioception = StateBlocks(std::vector<std::string>{"state"});
  HostedEnvironment environment = Make(config, /*image=*/true);
  EXPECT_THAT(environment.spec().cameras, ElementsAre("camera"));
  EXPECT_EQ(environment.spec().FrameBytes(), 3 * 16 * 16);
  EXPECT_EQ(environment.spec().blocks,
            (std::vector<BlockSpec>{{"state", 2, true}, {"robot.arm", 1, false}}));
  Reset(environment);
  EXPECT_THAT(frame_, testing::Each(7));
}

TEST_F(HostedEnvironmentTest, WhatCannotBeIsRefusedByName) {
  const auto refusal = [this](Config config, bool image) {
    return ErrorMessage([&] { Make(config, image); });
  };
  Config config = StateConfig();
  config.observation.pixels = true;
  EXPECT_THAT(refusal(config, false), HasSubstr("observes no image"));
  config.observation.cameras = {"front", "top"};
  EXPECT_THAT(refusal(config, true), AllOf(HasSubstr("'front'"), HasSubstr("are: camera")));
  config = StateConfig();
  config.observation.proprioception = StateBlocks(std::vector<std::string>{"leg"});
  EXPECT_THAT(refusal(config, false), AllOf(HasSubstr("'leg'"), HasSubstr("state, robot.arm")));
  config = StateConfig();
  config.model = "robot.xml";
  EXPECT_THAT(refusal(config, false), HasSubstr("model belongs to Shoal's own worlds"));
  config = StateConfig();
  config.observation.goal_mode = "both";
  EXPECT_THAT(refusal(config, false), HasSubstr("has no goals"));
}

TEST_F(HostedEnvironmentTest, TheSpecsHashCoversTheSpaces) {
  const Config config = StateConfig();
  tasks::EnvironmentDescription other = Description();
  const uint64_t hash = SpecOf(other, config).Hash();
  EXPECT_EQ(SpecOf(Description(), config).Hash(), hash);
  other.action.high[0] = 3;
  EXPECT_NE(SpecOf(other, config).Hash(), hash);
}

}  // namespace
}  // namespace shoal::hosted
