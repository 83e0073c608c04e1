// SPDX-License-Identifier: Apache-2.0
// SAC learns from pictures: a replay stores records as actors send them and draws stacked and
// shifted batches, and the learned policy acts on pictures stacked by an actor.
//
// Two cameras show a bar each, in episodes of two steps. The best action depends on the motion of
// the first camera's bar since the previous frame, and so on the order of the frames of a stack, on
// the order of the cameras, and on an equal shift for all frames. The motion of the second camera's
// bar has no meaning.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "common/base/aligned_bytes.h"
#include "common/nn/policy.h"
#include "common/spec/frame_stack.h"
#include "common/spec/record.h"
#include "learner/agent/algorithms.h"
#include "replay_server/core/replay_core.h"
#include "tests/learner/agent/agent_fixture.h"
#include "tests/learner/agent/bar_pictures.h"

namespace shoal::learner {
namespace {

constexpr int kSide = 24, kPlane = kSide * kSide, kEpisodes = 1500, kUpdates = 600;

RunConfig BarsRun() {
  RunConfig run;
  run.spec.task = "bars";
  run.spec.cameras = {"front", "side"};
  run.spec.channels = 2;
  run.spec.height = run.spec.width = kSide;
  run.spec.stack = 2;
  run.spec.action_size = 1;
  run.config.run_name = "bars";
  run.config.actors = 1;
  run.config.replay.storage = "memory";
  run.config.replay.capacity = 4 * kEpisodes;
  run.config.replay.min_size = 100;
  run.config.replay.samples_per_insert = Schedule::Constant(0);
  run.config.replay.shift_pad = 2;
  run.config.learner.batch = 64;
  run.config.learner.learning_rate = 2e-3;
  run.config.learner.reward_scale = 5;
  run.config.learner.discount = 0;  // a bandit: what follows counts nothing
  run.config.network.pool = 1;
  run.config.network.filters = {8, 16};
  run.config.network.strides = {2, 1};
  run.config.network.hidden = {32, 32};
  return run;
}

using Frame = std::array<uint8_t, 2 * kPlane>;

// A frame of both cameras; returns where the first camera's bar is, from -1 to 1.
float DrawFrame(Random* random, Frame* frame) {
  const std::span<uint8_t> planes(*frame);
  const auto column = [&] { return int(random->Below(kSide - kBarWidth + 1)); };
  DrawBar(column(), kSide, planes.subspan(kPlane));
  return DrawBar(column(), kSide, planes.first(kPlane));
}

// The best action after the first camera's bar has moved from one place to the other.
float Best(float from, float to) { return 0.4f * (to - from); }

// Episodes of uniform random actions, as one actor sends them.
void Play(replay::ReplayCore* core) {
  const RecordLayout layout(core->run().spec);
  const auto bytes = size_t(layout.record_bytes());
  std::vector<uint64_t> records(3 * bytes / sizeof(uint64_t));  // aligned as records are
  auto* data = reinterpret_cast<uint8_t*>(records.data());
  Random random(1);
  uint64_t sequence = 0;
  for (uint32_t episode = 0; episode < kEpisodes; ++episode) {
    std::memset(data, 0, 3 * bytes);
    float before = 0, now = 0;  // places of the bar in the stack that an action is chosen by
    for (uint32_t index = 0; index < 3; ++index) {
      uint8_t* record = data + index * bytes;
      RecordHeader& header = RecordLayout::Header(record);
      header.sequence = ++sequence;
      header.episode = episode;
      header.index = index;
      header.kind = index == 0 ? RecordKind::kReset : RecordKind::kStep;
      header.flags = index == 2 ? kTerminated : 0;
      header.version = kRecordVersion;
      if (index > 0) {
        const float action = float(random.Uniform(-1, 1)), error = action - Best(before, now);
        layout.Action(record)[0] = action;
        header.reward = -error * error;
      }
      Frame frame;
      before = now;
      now = DrawFrame(&random, &frame);
      if (index == 0) before = now;
      std::ranges::copy(frame, layout.Frame(record).begin());
    }
    const ChunkResult result = core->TakeChunk({.spec_hash = core->run().spec.Hash(),
                                                .actor = 0,
                                                .count = 3,
                                                .session = 1,
                                                .first_sequence = sequence - 2,
                                                .payload = {data, 3 * bytes}});
    ASSERT_EQ(result.stored, 3u);
  }
}

void Learn(replay::ReplayCore* core, Agent* agent) {
  const BatchSchema& schema = core->batch_schema();
  const AlignedBytes memory(schema.total_bytes());
  for (uint64_t u = 1; u <= kUpdates; ++u) {
    core->TakeRequest({.spec_hash = core->run().spec.Hash(),
                       .learner_session = 1,
                       .request = u,
                       .batch = uint32_t(schema.batch()),
                       .schema_hash = schema.Hash()});
    const auto drawn = core->TryAnswer(memory.data());
    ASSERT_TRUE(drawn.has_value());
    ASSERT_TRUE(agent->Update(schema.View(memory.data(), drawn->stored_steps)).finite);
  }
}

// Mean distances from what is best, over pictures that were not learned from.
struct Errors {
  double learned = 0, nothing = 0, random = 0;
};

Errors Judge(const RunConfig& run, const nn::TensorMap& tensors) {
  constexpr int kPictures = 400;
  nn::Policy policy(run.config.network, run.spec, nn::Precision::kF32, 1);
  policy.Load(tensors, "agent");
  std::vector<uint8_t> memory(2 * sizeof(Frame));
  Random random(2);
  Errors errors;
  for (int i = 0; i < kPictures; ++i) {
    FrameStack stack(memory, sizeof(Frame));
    Frame frame;
    const float before = DrawFrame(&random, &frame);
    stack.Reset(frame);
    const float now = DrawFrame(&random, &frame);
    stack.Push(frame);
    const float best = Best(before, now);
    const float action = std::tanh(policy.Forward(1, memory.data(), nullptr).mean[0]);
    errors.learned += std::abs(action - best) / kPictures;
    errors.nothing += std::abs(best) / kPictures;
    errors.random += std::abs(random.Uniform(-1, 1) - best) / kPictures;
  }
  return errors;
}

TEST(PixelsLearn, SacLearnsHowFarABarHasMoved) {
  const RunConfig run = BarsRun();
  replay::ReplayCore core(run, /*folder=*/"", /*replay_session=*/1);
  ASSERT_NO_FATAL_FAILURE(Play(&core));
  const auto agent = MakeAgent(run.config, run.spec, nn::Precision::kF32);
  const Errors before = Judge(run, agent->PolicyTensors());
  ASSERT_NO_FATAL_FAILURE(Learn(&core, agent.get()));
  const Errors after = Judge(run, agent->PolicyTensors());
  EXPECT_LT(after.learned, 0.3 * after.nothing) << "untrained: " << before.learned;
  EXPECT_LT(after.learned, 0.3 * after.random);
  RecordProperty("error", std::to_string(after.learned));
}

}  // namespace
}  // namespace shoal::learner
