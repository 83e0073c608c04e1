// SPDX-License-Identifier: Apache-2.0
// Every kind of observation, from the configuration to a batch that a network takes: spec, records
// of a short random rollout, ring, batch, one update, `shoal replay peek`.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "actor/worlds/environment.h"
#include "common/config/config_io.h"
#include "common/config/run_files.h"
#include "launch/check/local_collection.h"
#include "learner/agent/algorithms.h"
#include "replay_server/core/peek.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

struct Kind {
  std::string goal_mode;
  bool proprioception, grey, pixels;
  int stack, cameras;
};

// Heights and widths that differ and are no multiple of each other.
constexpr int kHeight = 20, kWidth = 28;

Config ConfigOf(const Kind& kind) {
  static const std::vector<std::string> cameras{"close", "front", "side"};
  Config config;
  config.task = "FetchReachDense";
  config.run_name = "kinds";
  config.envs_per_actor = 2;
  ObservationConfig& observation = config.observation;
  observation.pixels = kind.pixels;
  observation.cameras.assign(cameras.begin(), cameras.begin() + kind.cameras);
  observation.grey = kind.grey;
  observation.height = kHeight;
  observation.width = kWidth;
  observation.stack = kind.stack;
  observation.goal_mode = kind.goal_mode;
  observation.proprioception = kind.proprioception;
  config.replay.capacity = 128;
  config.replay.min_size = 8;
  config.replay.samples_per_insert = Schedule::Constant(0);
  config.replay.shift_pad = 2;
  config.learner.batch = 4;
  config.network.filters = {4};
  config.network.strides = {2};
  config.network.features = 6;
  config.network.hidden = {8};
  return config;
}

RunConfig RunOf(const Config& config) {
  Validate(config);
  std::shared_ptr<worlds::RenderContext> render;
  if (config.observation.pixels) render = worlds::MakeRenderContext(config.observation);
  return {config, worlds::MakeEnvironment(config, render)->spec()};
}

class Observations : public testing::TestWithParam<Kind> {};

TEST_P(Observations, GoAllTheWayFromConfigurationToUpdate) {
  const Kind& kind = GetParam();
  const TemporaryFolder folder;
  const RunConfig run = RunOf(ConfigOf(kind));
  WriteRunConfig(folder.path(), run);
  EXPECT_EQ(ReadRunConfig(folder.path()).spec, run.spec);

  // Spec.
  const bool state = kind.proprioception || !kind.pixels;
  const int vector =
      (state ? 10 : 0) + (kind.goal_mode == "both" ? 6 : 0) + (kind.goal_mode == "desired" ? 3 : 0);
  const int channels = kind.pixels ? kind.cameras * (kind.grey ? 1 : 3) : 0;
  EXPECT_EQ(run.spec.VectorSize(), vector);
  EXPECT_EQ(run.spec.channels, channels);
  EXPECT_EQ(run.spec.FrameBytes(), kind.pixels ? channels * kHeight * kWidth : 0);
  EXPECT_EQ(run.spec.stack, kind.stack);

  // Records, ring, batch.
  LocalCollection collection(run, folder.path());
  collection.Collect(60);
  EXPECT_EQ(collection.core().counters().intake.rejected, 0u);
  EXPECT_GE(collection.core().ring().stored_steps(), 60u);
  const BatchView batch = collection.Draw();
  const auto elements = static_cast<size_t>(run.config.learner.batch);
  EXPECT_EQ(batch.obs_frames.size(),
            elements * static_cast<size_t>(run.spec.FrameBytes() *
                                           (kind.stack + (kind.goal_mode == "image" ? 1 : 0))));
  EXPECT_EQ(batch.next_obs_vector.size(), elements * static_cast<size_t>(vector));
  if (kind.pixels) {
    // Not one flat colour, in no channel of no element.
    const size_t plane = size_t{kHeight} * kWidth;
    for (size_t at = 0; at < batch.obs_frames.size(); at += plane) {
      const auto [low, high] = std::ranges::minmax(batch.obs_frames.subspan(at, plane));
      EXPECT_GT(high - low, 30) << "plane " << at / plane;
    }
  }

  // One update on it.
  const auto agent = learner::MakeAgent(run.config, run.spec, nn::Precision::kF32);
  EXPECT_TRUE(agent->Update(batch).finite);

  // A look into the ring.
  const replay::Peek peek = replay::PeekBatch(folder.path(), 3, 1);
  EXPECT_EQ(peek.captions.size(), 3u);
  EXPECT_GE(peek.sampleable, 50u);
  EXPECT_EQ(peek.rgb.empty(), !kind.pixels);
  if (kind.pixels) {
    EXPECT_GE(peek.width, 3 * kWidth);
    EXPECT_GE(peek.height, (kind.goal_mode == "image" ? 5 : 4) * kind.cameras * kHeight);
  }
}

// Set-up of the preset fetch-push-image-goals: stored frames show goals of hindsight, and the
// critic gets them as numbers.
TEST(ImageGoals, GoWithHindsightAndACriticWithoutPixels) {
  const TemporaryFolder folder;
  Config config = ConfigOf({"image", true, false, /*pixels=*/true, /*stack=*/1, /*cameras=*/2});
  config.task = "FetchPush";
  config.replay.capacity = 1000;
  config.replay.hindsight = "future";
  config.learner.batch = 32;
  config.sac.critic_blocks = true;
  config.sac.aux = {"object-desired_goal"};
  config.learner.bounded_targets = true;
  config.observation.proprioception = StateBlocks(std::vector<std::string>{"grip"});
  const RunConfig run = RunOf(config);
  WriteRunConfig(folder.path(), run);
  LocalCollection collection(run, folder.path());
  collection.Collect(220);  // two episodes of each of the two environments
  const auto agent = learner::MakeAgent(run.config, run.spec, nn::Precision::kF32);
  for (int update = 0; update < 5; ++update) {
    EXPECT_TRUE(agent->Update(collection.Draw()).finite) << update;
  }
  EXPECT_GT(collection.core().counters().relabelled, 50u);
  EXPECT_LT(collection.core().counters().relabelled, 5u * 32u);
}

std::vector<Kind> AllKinds() {
  std::vector<Kind> kinds;
  for (const char* mode : {"none", "desired", "both"}) {
    for (const bool proprioception : {false, true}) {
      kinds.push_back({mode, proprioception, false, /*pixels=*/false, 1, 1});
      for (const bool grey : {false, true}) {
        for (int stack = 1; stack <= 4; ++stack) {
          // One, two or three cameras: every number meets every other choice, not every pair.
          const int cameras = 1 + (stack + grey + proprioception) % 3;
          kinds.push_back({mode, proprioception, grey, /*pixels=*/true, stack, cameras});
        }
      }
    }
  }
  kinds.push_back({"image", false, false, /*pixels=*/true, /*stack=*/1, /*cameras=*/2});
  kinds.push_back({"image", true, true, /*pixels=*/true, /*stack=*/3, /*cameras=*/1});
  // Nothing to observe is refused (config tests).
  std::erase_if(kinds, [](const Kind& kind) {
    return !kind.pixels && kind.goal_mode == "none" && !kind.proprioception;
  });
  return kinds;
}

std::string NameOf(const testing::TestParamInfo<Kind>& info) {
  const Kind& kind = info.param;
  return "goal_" + kind.goal_mode + (kind.proprioception ? "_state" : "") +
         (!kind.pixels
              ? "_blind"
              : std::string(kind.grey ? "_grey" : "_rgb") + "_stack" + std::to_string(kind.stack) +
                    "_cameras" + std::to_string(kind.cameras));
}

INSTANTIATE_TEST_SUITE_P(All, Observations, testing::ValuesIn(AllKinds()), NameOf);

}  // namespace
}  // namespace shoal::launch
