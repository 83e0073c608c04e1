// SPDX-License-Identifier: Apache-2.0
#include "launch/run/baselines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

class BaselinesTest : public testing::Test {
 protected:
  Baselines Measure(const Config& config) {
    return cache_
        .Measure(
            config, [] { return false; }, [this](const std::string&) { ++measured_; })
        .value();
  }

  const TemporaryFolder folder_;
  const BaselineCache cache_{folder_.path() / "baselines", 4};
  int measured_ = 0;
};

TEST_F(BaselinesTest, AreMeasuredOnceAndKept) {
  const Config config;
  EXPECT_FALSE(cache_.Find(config));
  const Baselines first = Measure(config);
  EXPECT_EQ(first.noop.episodes, 4u);
  EXPECT_NE(first.noop.return_mean, first.random.return_mean);
  EXPECT_EQ(Measure(config).random.return_mean, first.random.return_mean);
  EXPECT_EQ(measured_, 1);
  ASSERT_TRUE(cache_.Find(config));
  EXPECT_THAT(FormatBaselines(first), testing::HasSubstr("(4 episodes each)"));
}

TEST_F(BaselinesTest, AnotherTaskThresholdOrModelHasItsOwn) {
  Config config;
  Measure(config);
  Config other = config;
  other.distance_threshold = 10;
  EXPECT_FALSE(cache_.Find(other));
  EXPECT_EQ(Measure(other).noop.success, 1.0);
  other = config;
  other.task = "FetchReach";
  EXPECT_FALSE(cache_.Find(other));
  other = config;
  other.model = folder_.path() / "robot.xml";
  WriteFileAtomically(other.model, "<mujoco/>");
  EXPECT_FALSE(cache_.Find(other));
  EXPECT_THROW(Measure(other), Error) << "no model of a Fetch";
}

TEST_F(BaselinesTest, ASpoiltFileIsMeasuredAnew) {
  const Config config;
  const double before = Measure(config).noop.return_mean;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "baselines")) {
    std::ofstream(entry.path()) << "{";
  }
  EXPECT_FALSE(cache_.Find(config));
  EXPECT_EQ(Measure(config).noop.return_mean, before);
}

TEST_F(BaselinesTest, AModelThatIsGoneHasNone) {
  Config config;
  config.model = folder_.path() / "gone.xml";
  EXPECT_FALSE(cache_.Find(config));
  EXPECT_THROW(Measure(config), Error);
}

TEST_F(BaselinesTest, AnEnvironmentOfPythonHasNone) {
  Config config;
  Measure(config);
  config.env.id = "module:Fetch";
  EXPECT_FALSE(HasBaselines(config));
  EXPECT_FALSE(cache_.Find(config)) << "those of the task of the same name";
}

TEST_F(BaselinesTest, AStopIsNoError) {
  const Config config;
  EXPECT_FALSE(cache_.Measure(
      config, [] { return true; }, [](const std::string&) {}));
  EXPECT_FALSE(cache_.Find(config)) << "nothing half-measured is kept";
}

TEST(ShareBaselines, IsAboutTheWorldNotThePolicy) {
  const Config config;
  Config other = config;
  other.learner.batch = 7;
  other.observation.pixels = !config.observation.pixels;
  EXPECT_TRUE(ShareBaselines(config, other));
  const auto differs = [&](auto change) {
    Config changed = config;
    change(changed);
    return !ShareBaselines(config, changed);
  };
  EXPECT_TRUE(differs([](Config& c) { c.task = "FetchPush"; }));
  EXPECT_TRUE(differs([](Config& c) { c.env.id = "module:" + c.task; }));
  EXPECT_TRUE(differs([](Config& c) { c.env.kwargs.json = R"({"wind": 1})"; }));
  EXPECT_TRUE(differs([](Config& c) { c.distance_threshold = 0.1; }));
  EXPECT_TRUE(differs([](Config& c) { c.model = "mine.xml"; }));
  EXPECT_TRUE(differs([](Config& c) { c.physics = "mujoco3"; }));
  EXPECT_TRUE(differs([](Config& c) { c.action_repeat = 4; }));
  EXPECT_TRUE(differs([](Config& c) { c.end_on_success = true; }));
}

}  // namespace
}  // namespace shoal::launch
