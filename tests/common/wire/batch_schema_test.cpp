// SPDX-License-Identifier: Apache-2.0
#include "common/wire/batch_schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "common/base/aligned_bytes.h"

namespace shoal {
namespace {

ObservationSpec Spec() {
  ObservationSpec spec;
  spec.channels = 3;
  spec.height = 5;
  spec.width = 7;
  spec.stack = 2;
  spec.blocks = {{"observation", 3}};
  spec.action_size = 4;
  return spec;
}

AlignedBytes Memory(const BatchSchema& schema) { return AlignedBytes(schema.total_bytes()); }

TEST(BatchSchema, ArraysAreAlignedDisjointAndInside) {
  const BatchSchema schema(Spec(), {.batch = 3});
  const auto memory = Memory(schema);
  const BatchView view = schema.View(memory.data());
  EXPECT_EQ(view.obs_frames.size(), 3u * 210);
  EXPECT_EQ(view.next_obs_frames.size(), 3u * 210);
  EXPECT_EQ(view.obs_vector.size(), 9u);
  EXPECT_EQ(view.action.size(), 12u);
  EXPECT_EQ(view.reward.size(), 3u);
  EXPECT_EQ(view.weights_update.size(), 3u);
  EXPECT_EQ(view.id.size(), 3u);

  const uint8_t* end = memory.data();
  const auto check = [&](const auto& array) {
    const auto* begin = reinterpret_cast<const uint8_t*>(array.data());
    EXPECT_EQ((begin - memory.data()) % 64, 0);
    EXPECT_GE(begin, end);
    end = begin + array.size_bytes();
  };
  check(view.obs_frames);
  check(view.next_obs_frames);
  check(view.obs_vector);
  check(view.next_obs_vector);
  check(view.action);
  check(view.reward);
  check(view.bootstrap);
  check(view.weights_update);
  check(view.id);
  EXPECT_LE(end, memory.data() + schema.total_bytes());
}

TEST(BatchSchema, GivesArraysByNameAndType) {
  const BatchSchema schema(Spec(), {.batch = 3});
  const auto memory = Memory(schema);
  const BatchView view = schema.View(memory.data());
  EXPECT_EQ(view.Array<float>("action").data(), view.action.data());
  EXPECT_EQ(view.Array<uint64_t>("id").data(), view.id.data());
  EXPECT_EQ(view.Array<uint8_t>("obs_frames").size(), 3u * 210);
  EXPECT_FALSE(schema.Has("importance_weight"));
  EXPECT_DEATH(view.Array<float>("importance_weight"), "no array 'importance_weight'");
  EXPECT_DEATH(view.Array<float>("id"), "array 'id' is u64");
}

TEST(BatchSchema, HasTheStepsOfSequences) {
  const BatchSchema schema(Spec(), {.batch = 3, .horizon = 2});
  const auto memory = Memory(schema);
  const BatchView view = schema.View(memory.data());
  ASSERT_EQ(view.steps.size(), 2u);
  EXPECT_EQ(view.steps[1].next_frames.size(), 3u * 210);
  EXPECT_EQ(view.steps[1].next_vector.size(), 9u);
  EXPECT_EQ(view.steps[1].action.size(), 12u);
  EXPECT_EQ(view.steps[1].reward.size(), 3u);
  EXPECT_EQ(view.steps[1].terminated.size(), 3u);
  EXPECT_EQ(view.steps[1].present.data(), view.Array<float>("step2.present").data());
  EXPECT_FALSE(schema.Has("step3.present"));
  EXPECT_NE(schema.Hash(), BatchSchema(Spec(), {.batch = 3, .horizon = 1}).Hash());
}

TEST(BatchSchema, HasNoArraysForWhatTheSpecDoesNotHave) {
  ObservationSpec spec = Spec();
  spec.channels = spec.height = spec.width = 0;
  const BatchSchema state(spec, {.batch = 3});
  EXPECT_FALSE(state.Has("obs_frames"));
  EXPECT_TRUE(state.Has("obs_vector"));
  const auto memory = Memory(state);
  EXPECT_TRUE(state.View(memory.data()).obs_frames.empty());
  spec = Spec();
  spec.blocks.clear();
  const BatchSchema pixels(spec, {.batch = 3});
  EXPECT_FALSE(pixels.Has("next_obs_vector"));
  EXPECT_EQ(pixels.Array<float>("action", Memory(pixels).data()).size(), 12u);
}

TEST(BatchSchema, TheHashTellsWhateverDiffers) {
  const BatchOptions options{.batch = 3, .copies = 1, .n_step = 2, .discount = 0.9};
  std::set<uint64_t> hashes{BatchSchema(Spec(), options).Hash()};
  const auto add_options = [&](const std::function<void(BatchOptions&)>& change) {
    BatchOptions changed = options;
    change(changed);
    hashes.insert(BatchSchema(Spec(), changed).Hash());
  };
  const auto add_spec = [&](const std::function<void(ObservationSpec&)>& change) {
    ObservationSpec changed = Spec();
    change(changed);
    hashes.insert(BatchSchema(changed, options).Hash());
  };
  add_options([](BatchOptions& o) { o.batch = 4; });
  add_options([](BatchOptions& o) { o.copies = 3; });
  add_options([](BatchOptions& o) { o.target_shifts = 1; });
  add_options([](BatchOptions& o) { o.critic_shifts = 1; });
  add_options([](BatchOptions& o) { o.n_step = 1; });
  add_options([](BatchOptions& o) { o.discount = 0.90000001; });
  add_options([](BatchOptions& o) { o.probabilities = true; });
  add_spec([](ObservationSpec& s) { s.stack = 1; });
  add_spec([](ObservationSpec& s) { s.action_size = 3; });
  add_spec([](ObservationSpec& s) { s.blocks.clear(); });
  EXPECT_EQ(hashes.size(), 11u);
  EXPECT_EQ(BatchSchema(Spec(), options).Hash(), BatchSchema(Spec(), options).Hash());
}

TEST(BatchSchema, SaysWhatABatchIsInOneLine) {
  EXPECT_EQ(BatchSchema(Spec(), {.batch = 3, .discount = 0.9}).Summary(),
            "batch 3, copies 1, n_step 1, discount 0.9: obs_frames u8 6x5x7, next_obs_frames u8 "
            "6x5x7, obs_vector f32 3, next_obs_vector f32 3, action f32 4, reward f32, bootstrap "
            "f32, weights_update u64, id u64");
}

}  // namespace
}  // namespace shoal
