// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/batch_gather.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <set>
#include <utility>
#include <vector>

#include "common/base/aligned_bytes.h"
#include "tests/replay_server/record_script.h"

namespace shoal::replay {
namespace {

// Draws the ids of a list.
class ListedSelector : public Selector {
 public:
  explicit ListedSelector(std::deque<uint64_t> ids) : ids_(std::move(ids)) {}
  void Added(uint64_t) override {}
  void Removed(uint64_t) override {}
  std::optional<Selection> Draw(Random*) override {
    if (ids_.empty()) return std::nullopt;
    const uint64_t id = ids_.front();
    ids_.pop_front();
    return Selection{id, 0.25};
  }
  uint64_t redraws() const override { return 0; }

 private:
  std::deque<uint64_t> ids_;
};

// One episode of four steps in ids 1 (reset) .. 5, the last one with `flags`; then another reset.
class BatchGatherTest : public testing::Test {
 protected:
  void Fill(const ObservationSpec& spec, uint8_t flags) {
    spec_ = spec;
    ring_.emplace(spec_, RingOptions{.file = {}, .capacity = 32, .run = ""});
    for (uint32_t i = 0; i < 5; ++i) {
      records_.push_back(MakeRecord(spec_, 0, 0, 0, i, i + 1, i == 4 ? flags : uint8_t{0}));
      ring_->Append(0, 1, i, records_.back().data());
    }
    ring_->Append(0, 1, 0, MakeRecord(spec_, 0, 0, 1, 0, 6).data());
  }

  BatchView Gather(const BatchPlan& plan, const NStep& n_step = {},
                   std::vector<std::string> privileged = {}, int horizon = 0) {
    schema_.emplace(spec_, BatchOptions{.batch = int(plan.elements.size()),
                                        .horizon = horizon,
                                        .privileged = std::move(privileged)});
    memory_ = AlignedBytes(schema_->total_bytes());
    std::fill_n(memory_.data(), schema_->total_bytes(), uint8_t{0});  // between the arrays, too
    BatchView view = schema_->View(memory_.data());
    const EpisodeIndex index(*ring_,
                             {.stack = spec_.stack, .n_step = std::max(n_step.steps, horizon)});
    BatchGather(*ring_, index, spec_, n_step, nullptr, schema_->options().privileged)
        .Gather(plan, view);
    return view;
  }

  // The frame of the episode's record `index`, shifted.
  std::vector<uint8_t> Frame(size_t index, Shift shift) {
    const auto frame = ring_->layout().Frame(records_[index].data());
    std::vector<uint8_t> out(frame.size());
    ShiftPlanes(frame.data(), spec_.channels, spec_.height, spec_.width, shift, out.data());
    return out;
  }
  std::vector<uint8_t> Stack(std::initializer_list<size_t> indices, Shift shift) {
    std::vector<uint8_t> stack;
    for (const size_t index : indices) {
      const auto frame = Frame(index, shift);
      stack.insert(stack.end(), frame.begin(), frame.end());
    }
    return stack;
  }
  // The script has three blocks of 2 numbers; the middle one is recorded only.
  std::vector<float> Observed(size_t index) {
    const auto all = ring_->layout().Vector(records_[index].data());
    return {all[0], all[1], all[4], all[5]};
  }
  static std::vector<uint8_t> Bytes(std::span<const uint8_t> bytes) {
    return {bytes.begin(), bytes.end()};
  }

  ObservationSpec spec_;
  std::optional<Ring> ring_;
  std::vector<std::vector<uint8_t>> records_;
  std::optional<BatchSchema> schema_;
  AlignedBytes memory_;
};

TEST_F(BatchGatherTest, AStackAtAnEpisodesStartRepeatsTheFirstFrame) {
  Fill(TinySpec(3), kTruncated);
  const BatchView first = Gather({.elements = {{.id = 2, .obs = {}, .next_obs = {}}}});
  EXPECT_EQ(Bytes(first.obs_frames), Stack({0, 0, 0}, {}));
  EXPECT_EQ(Bytes(first.next_obs_frames), Stack({0, 0, 1}, {}));
  const BatchView last = Gather({.elements = {{.id = 5, .obs = {}, .next_obs = {}}}});
  EXPECT_EQ(Bytes(last.obs_frames), Stack({1, 2, 3}, {}));
  EXPECT_EQ(Bytes(last.next_obs_frames), Stack({2, 3, 4}, {}));
}

TEST_F(BatchGatherTest, OneShiftHoldsForAllFramesAndChannelsOfAStackAndAnotherForTheNext) {
  Fill(TinySpec(2, 9, 7), 0);
  const Shift obs{.dx = 2, .dy = -1}, next{.dx = -3, .dy = 4};
  const BatchView view = Gather({.elements = {{.id = 4, .obs = obs, .next_obs = next}}});
  EXPECT_EQ(Bytes(view.obs_frames), Stack({1, 2}, obs));
  EXPECT_EQ(Bytes(view.next_obs_frames), Stack({2, 3}, next));
}

// Parts in another order, as threads may run them, and copies that they do not divide evenly.
TEST_F(BatchGatherTest, TheBytesDoNotDependOnHowTheFramesAreShared) {
  Fill(TinySpec(2, 90, 70), kTerminated);
  BatchPlan plan;
  for (int b = 0; b < 27; ++b) {
    plan.elements.push_back({.id = uint64_t(2 + b % 4),
                             .obs = {.dx = b % 5 - 2, .dy = b % 3 - 1},
                             .next_obs = {.dx = b % 4 - 2, .dy = b % 7 - 3}});
  }
  Gather(plan, {.steps = 2, .discount = 0.5});
  const AlignedBytes alone = std::move(memory_);
  const auto bytes = [&](const AlignedBytes& memory) {
    return std::vector<uint8_t>(memory.data(), memory.data() + schema_->total_bytes());
  };
  memory_ = AlignedBytes(schema_->total_bytes());
  std::fill_n(memory_.data(), schema_->total_bytes(), uint8_t{0});
  const EpisodeIndex index(*ring_, {.stack = spec_.stack, .n_step = 2});
  const FrameCopies copies = BatchGather(*ring_, index, spec_, {.steps = 2, .discount = 0.5})
                                 .GatherAllButFrames(plan, schema_->View(memory_.data()));
  EXPECT_EQ(copies.copies.size(), 27u * 4);
  EXPECT_EQ(copies.oldest, 1u);
  EXPECT_NE(bytes(memory_), bytes(alone)) << "no frame is copied yet";
  ASSERT_GE(copies.parts(), 3);
  for (int part = copies.parts() - 1; part >= 0; --part) copies.MakePart(part);
  EXPECT_EQ(bytes(memory_), bytes(alone));
}

TEST_F(BatchGatherTest, ASequenceHasTheStepsThatFollowWithShiftsOfTheirOwn) {
  Fill(TinySpec(2, 9, 7), 0);
  const std::vector<Shift> shifts{{1, 0}, {0, 2}, {-3, 1}};
  const BatchView view =
      Gather({.elements = {{.id = 3, .obs = {}, .next_obs = {}, .steps = shifts}}},
             {.steps = 2, .discount = 0.5}, {}, 3);
  ASSERT_EQ(view.steps.size(), 3u);
  for (size_t h = 0; h < 3; ++h) {
    const size_t index = 2 + h;  // of the step's record
    const StepView& step = view.steps[h];
    EXPECT_EQ(Bytes(step.next_frames), Stack({index - 1, index}, shifts[h])) << h;
    EXPECT_EQ(std::vector<float>(step.next_vector.begin(), step.next_vector.end()),
              Observed(index));
    const auto action = ring_->layout().Action(records_[index].data());
    EXPECT_TRUE(std::ranges::equal(step.action, action)) << h;
    EXPECT_EQ(step.reward[0], RecordLayout::Header(records_[index].data()).reward);
    EXPECT_EQ(step.terminated[0], 0);
    EXPECT_EQ(step.present[0], 1);
  }
  EXPECT_EQ(view.steps[0].action[0], view.action[0]);
  EXPECT_EQ(view.reward[0], view.steps[0].reward[0] + 0.5f * view.steps[1].reward[0]);
}

TEST_F(BatchGatherTest, ASequenceEndsWithTheStepThatTerminatesItsEpisode) {
  Fill(TinySpec(1), kTerminated);
  const BatchPlan plan{.elements = {{.id = 4, .obs = {}, .next_obs = {}, .steps = {{}, {}, {}}},
                                    {.id = 2, .obs = {}, .next_obs = {}, .steps = {{}, {}, {}}}}};
  const BatchView view = Gather(plan, {}, {}, 3);
  const auto of_first = [&](auto member) {
    std::vector<float> values;
    for (const StepView& step : view.steps) values.push_back((step.*member)[0]);
    return values;
  };
  EXPECT_EQ(of_first(&StepView::present), (std::vector<float>{1, 1, 0}));
  EXPECT_EQ(of_first(&StepView::terminated), (std::vector<float>{0, 1, 0}));
  const StepView& absent = view.steps[2];
  EXPECT_EQ(absent.reward[0], 0);
  EXPECT_EQ(absent.next_vector[0], 0);
  EXPECT_EQ(absent.action[0], 0);
  EXPECT_EQ(absent.next_frames[0], 0);
  EXPECT_EQ(absent.present[1], 1) << "the other row has three steps";
}

TEST_F(BatchGatherTest, APlanDrawsAShiftForEachStepOfASequence) {
  Fill(TinySpec(1), 0);
  Random random(3);
  ListedSelector selector({2, 2});
  const auto plan =
      DrawPlan({.batch = 2, .horizon = 40, .shift_pad = 2}, &selector, nullptr, &random);
  ASSERT_TRUE(plan);
  std::set<std::pair<int, int>> seen;
  for (const BatchPlan::Element& element : plan->elements) {
    ASSERT_EQ(element.steps.size(), 40u);
    for (const Shift& shift : element.steps) seen.insert({shift.dx, shift.dy});
  }
  EXPECT_GT(seen.size(), 20u) << "of 25";
}

TEST_F(BatchGatherTest, PrivilegedBlocksAreThoseOfTheSameRecordsAsTheVectors) {
  Fill(TinySpec(1), 0);
  const BatchPlan plan{
      .elements = {{.id = 4, .obs = {}, .next_obs = {}}, {.id = 3, .obs = {}, .next_obs = {}}}};
  const std::string hidden = spec_.blocks[1].name;
  ASSERT_FALSE(spec_.blocks[1].observed);
  const BatchView view = Gather(plan, {}, {hidden});
  const auto expect = [&](std::span<const float> all, size_t row, size_t record) {
    const auto recorded = ring_->layout().Vector(records_[record].data());
    EXPECT_EQ(all[2 * row], recorded[2]);
    EXPECT_EQ(all[2 * row + 1], recorded[3]);
  };
  expect(view.obs_privileged, 0, 2);
  expect(view.next_obs_privileged, 0, 3);
  expect(view.obs_privileged, 1, 1);
  expect(view.next_obs_privileged, 1, 2);
}

TEST_F(BatchGatherTest, ATimeLimitBootstrapsATerminationDoesNot) {
  const BatchPlan plan{
      .elements = {{.id = 4, .obs = {}, .next_obs = {}}, {.id = 5, .obs = {}, .next_obs = {}}}};
  for (const uint8_t flags : {uint8_t{kTruncated}, uint8_t{kTerminated},
                              uint8_t{kTerminated | kTruncated | kSuccess}, uint8_t{kSuccess}}) {
    records_.clear();
    Fill(TinySpec(1), flags);
    const BatchView view = Gather(plan);
    EXPECT_EQ(view.bootstrap[0], 1.0f);
    EXPECT_EQ(view.bootstrap[1], (flags & kTerminated) != 0 ? 0.0f : 1.0f) << int{flags};
  }
}

TEST_F(BatchGatherTest, NStepsSumTheRewardsFromTheFirstActionOn) {
  Fill(TinySpec(2), 0);
  const BatchView view =
      Gather({.elements = {{.id = 3, .obs = {}, .next_obs = {}}}}, {.steps = 3, .discount = 0.5});
  const auto reward = [&](size_t i) { return RecordLayout::Header(records_[i].data()).reward; };
  EXPECT_FLOAT_EQ(view.reward[0], reward(2) + 0.5f * reward(3) + 0.25f * reward(4));
  EXPECT_FLOAT_EQ(view.bootstrap[0], 0.25f);
  EXPECT_EQ(view.id[0], 3u);
  EXPECT_EQ(Bytes(view.obs_frames), Stack({0, 1}, {}));
  EXPECT_EQ(Bytes(view.next_obs_frames), Stack({3, 4}, {}));
  EXPECT_TRUE(std::ranges::equal(view.action, ring_->layout().Action(records_[2].data())));
}

TEST_F(BatchGatherTest, NStepsThatEndInATerminationDoNotBootstrap) {
  Fill(TinySpec(1), kTerminated);
  const BatchView view =
      Gather({.elements = {{.id = 4, .obs = {}, .next_obs = {}}}}, {.steps = 2, .discount = 0.5});
  EXPECT_EQ(view.bootstrap[0], 0.0f);
}

TEST_F(BatchGatherTest, StepsBeforeATerminationAreFewer) {
  Fill(TinySpec(2), kTerminated);
  const BatchView view = Gather(
      {.elements = {{.id = 4, .obs = {}, .next_obs = {}}, {.id = 5, .obs = {}, .next_obs = {}}}},
      {.steps = 3, .discount = 0.5});
  const auto reward = [&](size_t i) { return RecordLayout::Header(records_[i].data()).reward; };
  EXPECT_FLOAT_EQ(view.reward[0], reward(3) + 0.5f * reward(4));
  EXPECT_FLOAT_EQ(view.reward[1], reward(4));
  EXPECT_EQ(view.bootstrap[0], 0.0f);
  EXPECT_EQ(view.bootstrap[1], 0.0f);
  const std::vector<uint8_t> next = Stack({3, 4}, {});
  EXPECT_TRUE(std::ranges::equal(view.next_obs_frames.first(next.size()), next));
  EXPECT_TRUE(std::ranges::equal(view.next_obs_frames.last(next.size()), next));
}

TEST_F(BatchGatherTest, WorksWithoutPixels) {
  ObservationSpec spec = TinySpec(1);
  spec.cameras.clear();
  spec.channels = spec.height = spec.width = 0;
  Fill(spec, 0);
  const BatchView view = Gather({.elements = {{.id = 3, .obs = {}, .next_obs = {}}}});
  EXPECT_TRUE(view.obs_frames.empty());
  EXPECT_TRUE(std::ranges::equal(view.obs_vector, Observed(1)));
  EXPECT_TRUE(std::ranges::equal(view.next_obs_vector, Observed(2)));
  EXPECT_TRUE(std::ranges::equal(view.action, ring_->layout().Action(records_[2].data())));
}

TEST_F(BatchGatherTest, PlansShiftObservationAndNextIndependently) {
  Fill(TinySpec(1), 0);
  ListedSelector selector(std::deque<uint64_t>(200, 2));
  Random random(3);
  const auto plan = DrawPlan({.batch = 200, .shift_pad = 4}, &selector, nullptr, &random);
  ASSERT_TRUE(plan);
  int same = 0;
  for (const BatchPlan::Element& element : plan->elements) {
    same += element.obs == element.next_obs ? 1 : 0;
  }
  EXPECT_LT(same, 20) << "one of 81 pairs of offsets is equal by chance";
}

TEST_F(BatchGatherTest, CopiesOfAStepStandTogetherEachWithItsShifts) {
  Fill(TinySpec(1), 0);
  std::deque<uint64_t> ids;
  for (uint64_t i = 0; i < 50; ++i) ids.push_back(2 + i % 4);
  ListedSelector selector(ids);
  Random random(3);
  const auto plan =
      DrawPlan({.batch = 200, .copies = 4, .shift_pad = 4}, &selector, nullptr, &random);
  ASSERT_TRUE(plan);
  int same = 0;
  for (size_t b = 0; b < 200; ++b) {
    EXPECT_EQ(plan->elements[b].id, ids[b / 4]);
    same += b % 4 != 0 && plan->elements[b].obs == plan->elements[b - 1].obs ? 1 : 0;
  }
  EXPECT_LT(same, 20) << "one of 81 pairs of offsets is equal by chance";
  EXPECT_FALSE(selector.Draw(&random)) << "one draw for four elements";
}

// Against an oracle that draws all shifts of a step before it deals them out.
TEST_F(BatchGatherTest, ShiftsOfCopiesRepeatAfterAsManyAsTheirKindHas) {
  Fill(TinySpec(1), 0);
  constexpr int kPad = 4, kSteps = 50, kCopies = 6;
  for (const int target : {1, 2, 3, 6}) {
    for (const int critic : {1, 2, 3, 6}) {
      ListedSelector selector(std::deque<uint64_t>(kSteps, 2));
      Random random(3), again(3);
      const auto plan = DrawPlan({.batch = kSteps * kCopies,
                                  .copies = kCopies,
                                  .target_shifts = target,
                                  .critic_shifts = critic,
                                  .shift_pad = kPad},
                                 &selector, nullptr, &random);
      ASSERT_TRUE(plan);
      std::array<size_t, 2> most{};  // different ones of a step: of obs, of next_obs
      for (size_t step = 0; step < kSteps; ++step) {
        std::vector<Shift> obs, next_obs;
        for (int i = 0; i < std::max(target, critic); ++i) {
          if (i < critic) obs.push_back(DrawShift(kPad, &again));
          if (i < target) next_obs.push_back(DrawShift(kPad, &again));
        }
        std::array<std::set<std::pair<int, int>>, 2> seen;
        for (size_t i = 0; i < kCopies; ++i) {
          const BatchPlan::Element& element = plan->elements[step * kCopies + i];
          EXPECT_EQ(element.obs, obs[i % obs.size()]);
          EXPECT_EQ(element.next_obs, next_obs[i % next_obs.size()]);
          seen[0].insert({element.obs.dx, element.obs.dy});
          seen[1].insert({element.next_obs.dx, element.next_obs.dy});
        }
        for (size_t kind = 0; kind < 2; ++kind)
          most[kind] = std::max(most[kind], seen[kind].size());
      }
      EXPECT_EQ(most, (std::array{size_t(critic), size_t(target)}));
    }
  }
}

TEST_F(BatchGatherTest, NoShiftsSaidAreAsManyAsCopies) {
  Fill(TinySpec(1), 0);
  const auto draw = [](int target, int critic) {
    ListedSelector selector(std::deque<uint64_t>(10, 2));
    Random random(3);
    const auto plan = DrawPlan({.batch = 30,
                                .copies = 3,
                                .target_shifts = target,
                                .critic_shifts = critic,
                                .shift_pad = 4},
                               &selector, nullptr, &random);
    std::vector<std::pair<Shift, Shift>> shifts;
    for (const BatchPlan::Element& element : plan.value().elements) {
      shifts.emplace_back(element.obs, element.next_obs);
    }
    return shifts;
  };
  EXPECT_EQ(draw(0, 0), draw(3, 3));
  EXPECT_NE(draw(0, 0), draw(1, 3));
  EXPECT_DEATH(draw(2, 3), "2 and 3 shifts of 3 copies");
}

TEST_F(BatchGatherTest, APlanIsWholeOrNothing) {
  Fill(TinySpec(1), 0);
  ListedSelector selector({2, 3});
  Random random(3);
  EXPECT_FALSE(DrawPlan({.batch = 3, .shift_pad = 4}, &selector, nullptr, &random));
}

TEST_F(BatchGatherTest, ChecksTheShapeOfTheOutput) {
  Fill(TinySpec(1), 0);
  schema_.emplace(spec_, BatchOptions{.batch = 2});
  memory_ = AlignedBytes(schema_->total_bytes());
  const BatchPlan plan{.elements = {{.id = 4, .obs = {}, .next_obs = {}}}};
  const EpisodeIndex index(*ring_, {});
  EXPECT_DEATH(BatchGather(*ring_, index, spec_).Gather(plan, schema_->View(memory_.data())),
               "a batch of 2 for a plan of 1");
}

}  // namespace
}  // namespace shoal::replay
