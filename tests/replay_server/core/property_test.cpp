// Random histories of several actors against an oracle that keeps everything.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>

#include "replay_server/core/replay_core.h"
#include "tests/replay_server/oracle.h"
#include "tests/replay_server/record_script.h"

namespace shoal::replay {
namespace {

constexpr double kDiscount = 0.9;

// Drives a ring, its index and intake with what actors do and what goes wrong on the way.
class History {
 public:
  History(int stack, int n_step, uint64_t capacity, uint64_t seed)
      : spec_(TinySpec(stack)),
        layout_(spec_),
        ring_(spec_, {.file = {}, .capacity = capacity, .run = "history"}),
        sessions_(ring_.sessions()),
        index_(ring_, stack, n_step),
        intake_(spec_.Hash(), &ring_, &sessions_, &index_),
        oracle_{.capacity = capacity, .stack = stack, .n_step = n_step},
        random_(seed) {
    for (uint32_t actor = 0; actor < 3; ++actor) StartSession(actor);
  }

  void Event() {
    Actor& actor = actors_[random_.Below(actors_.size())];
    const uint64_t kind = random_.Below(40);
    const uint32_t count = 1 + static_cast<uint32_t>(random_.Below(6));
    if (kind == 0) return StartSession(actor.script->actor());
    if (kind == 1) return LoseSome(&actor, count);
    if (kind == 2) actor.script->Spoil(actor.next + random_.Below(count));
    // Now and then from before what is stored already: duplicates.
    const uint64_t back = kind < 8 ? random_.Below(actor.next) : 0;
    Deliver(&actor, actor.next - back, count + static_cast<uint32_t>(back));
  }

  void Check() {
    uint64_t sampleable = 0;
    for (uint64_t id = 1; id <= oracle_.all.size(); ++id) {
      ASSERT_EQ(index_.Sampleable(id), oracle_.Sampleable(id)) << "record " << id;
      sampleable += oracle_.Sampleable(id) ? 1 : 0;
    }
    ASSERT_EQ(index_.sampleable(), sampleable);
    ASSERT_EQ(ring_.last_id(), oracle_.all.size());
    for (const Actor& actor : actors_) CheckCounters(actor);
  }

  // Every element of a batch is what the oracle says its step looks like.
  void CheckBatch() {
    if (index_.sampleable() == 0) return;
    constexpr int kBatch = 16;
    UniformSampler sampler(ring_, index_);
    const auto plan = DrawPlan({.batch = kBatch}, &sampler, &random_);
    ASSERT_TRUE(plan.has_value());
    const BatchLayout batch_layout(spec_, kBatch);
    const std::unique_ptr<void, decltype(&std::free)> memory(
        std::aligned_alloc(64, batch_layout.total_bytes()), &std::free);
    const BatchView view = batch_layout.View(static_cast<uint8_t*>(memory.get()));
    BatchGather(ring_, spec_, {.steps = oracle_.n_step, .discount = kDiscount}).Gather(*plan, view);
    for (size_t b = 0; b < kBatch; ++b) CheckElement(plan->elements[b].id, b, view);
  }

  const RecordHeader& HeaderOf(uint64_t id) const { return oracle_.all[id - 1].header(); }
  uint64_t stored() const { return oracle_.all.size(); }
  uint64_t first_frame_repeats() const { return first_frame_repeats_; }

 private:
  struct Actor {
    std::unique_ptr<RecordScript> script;
    uint64_t next = 1;  // first sequence not dealt with
    uint64_t lost = 0;
    Oracle::Counts counts{};
  };

  void StartSession(uint32_t actor) {
    auto script = std::make_unique<RecordScript>(spec_, actor, ++last_session_);
    if (actor == actors_.size()) actors_.emplace_back();
    actors_[actor] = {.script = std::move(script)};
  }

  void Deliver(Actor* actor, uint64_t first, uint32_t count) {
    const ChunkResult result = intake_.Take(actor->script->Chunk(first, count));
    ASSERT_EQ(result.fate, ChunkFate::kDealtWith);
    ASSERT_EQ(result.duplicates, std::min<uint64_t>(count, actor->next - first));
    for (; actor->next < first + count; ++actor->next) {
      oracle_.Take(layout_, actor->script->actor(), actor->script->session(),
                   actor->script->At(actor->next), &actor->counts);
    }
  }

  // Nothing resends `count` records: the rest is offered until the replay takes them as lost.
  void LoseSome(Actor* actor, uint32_t count) {
    const uint64_t first = actor->next + count;
    for (int offer = 1; offer < Intake::kAheadOffers; ++offer) {
      ASSERT_EQ(intake_.Take(actor->script->Chunk(first, 3)).fate, ChunkFate::kAhead);
    }
    actor->next = first;
    actor->lost += count;
    Deliver(actor, first, 3);
  }

  void CheckCounters(const Actor& actor) {
    const auto i = sessions_.Find(actor.script->actor(), actor.script->session());
    ASSERT_EQ(i.has_value(), actor.next > 1);
    if (!i) return;
    const SessionCounters& counters = sessions_.at(*i);
    ASSERT_EQ(counters.highest, actor.next - 1);
    ASSERT_EQ(counters.stored(), actor.counts.stored);
    ASSERT_EQ(counters.rejected, actor.counts.rejected);
    ASSERT_EQ(counters.after_gap, actor.counts.after_gap);
    ASSERT_EQ(counters.lost, actor.lost);
    ASSERT_EQ(actor.counts.stored + actor.counts.rejected + actor.counts.after_gap + actor.lost,
              counters.highest);
  }

  void CheckElement(uint64_t id, size_t b, const BatchView& view) {
    ASSERT_TRUE(oracle_.Sampleable(id)) << "record " << id;
    const std::vector<uint64_t> steps = *oracle_.Steps(id);
    const Oracle::Stored &last = oracle_.all[id - 1], &first = oracle_.all[steps.back() - 1];
    const Oracle::Stored& before = oracle_.all[first.prev - 1];
    double reward = 0;
    for (const uint64_t step : steps) {  // newest first
      reward = oracle_.all[step - 1].header().reward + kDiscount * reward;
      CheckContinues(oracle_.all[oracle_.all[step - 1].prev - 1], last);
    }
    CheckStack(*oracle_.Stack(first.prev), view.obs_frames, b);
    CheckStack(*oracle_.Stack(id), view.next_obs_frames, b);
    if (before.header().index == 0) ++first_frame_repeats_;
    ASSERT_FLOAT_EQ(view.reward[b], static_cast<float>(reward));
    ASSERT_EQ(view.weights_update[b], first.header().weights_update);
    const bool terminated = (last.header().flags & kTerminated) != 0;
    const double bootstrap = terminated ? 0 : std::pow(kDiscount, oracle_.n_step - 1);
    ASSERT_FLOAT_EQ(view.bootstrap[b], static_cast<float>(bootstrap));
    ExpectFloats(layout_.Action(first.bytes.data()), view.action, b);
    ExpectFloats(layout_.Vector(before.bytes.data()), view.obs_vector, b);
    ExpectFloats(layout_.Vector(last.bytes.data()), view.next_obs_vector, b);
  }

  // Never across an episode's end: `before` is of the same episode and did not end it.
  void CheckContinues(const Oracle::Stored& before, const Oracle::Stored& last) {
    ASSERT_EQ(before.header().env, last.header().env);
    ASSERT_EQ(before.header().episode, last.header().episode);
    ASSERT_EQ(before.header().flags & (kTerminated | kTruncated), 0);
  }

  // `newest_first` ids against element b of `frames`, which has the oldest frame first.
  void CheckStack(const std::vector<uint64_t>& newest_first, std::span<const uint8_t> frames,
                  size_t b) {
    const size_t frame_bytes = static_cast<size_t>(layout_.frame_bytes());
    const size_t stack = newest_first.size();
    for (size_t k = 0; k < stack; ++k) {
      const auto expected =
          layout_.Frame(oracle_.all[newest_first[stack - 1 - k] - 1].bytes.data());
      const auto actual = frames.subspan((b * stack + k) * frame_bytes, frame_bytes);
      ASSERT_TRUE(std::ranges::equal(expected, actual)) << "frame " << k << " of element " << b;
    }
  }

  void ExpectFloats(std::span<const float> expected, std::span<const float> all, size_t b) {
    ASSERT_TRUE(std::ranges::equal(expected, all.subspan(b * expected.size(), expected.size())));
  }

  const ObservationSpec spec_;
  const RecordLayout layout_;
  Ring ring_;
  SessionTable sessions_;
  EpisodeIndex index_;
  Intake intake_;
  Oracle oracle_;
  Random random_;
  std::vector<Actor> actors_;  // the newest session of each
  uint64_t last_session_ = 0;
  uint64_t first_frame_repeats_ = 0;
};

struct Case {
  int stack, n_step;
};

class ReplayProperty : public testing::TestWithParam<Case> {};

TEST_P(ReplayProperty, AgreesWithAnOracleThatKeepsEverything) {
  for (const uint64_t seed : {1, 2, 3, 4}) {
    History history(GetParam().stack, GetParam().n_step, /*capacity=*/20 + 17 * seed, seed);
    for (int i = 0; i < 150; ++i) {
      history.Event();
      history.Check();
      history.CheckBatch();
      ASSERT_FALSE(HasFatalFailure()) << "seed " << seed << ", event " << i;
    }
    EXPECT_GT(history.stored(), 300u);
    EXPECT_GT(history.first_frame_repeats(), 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(StacksAndSteps, ReplayProperty,
                         testing::Values(Case{1, 1}, Case{2, 1}, Case{3, 1}, Case{1, 3},
                                         Case{3, 2}),
                         [](const auto& kind) {
                           return "Stack" + std::to_string(kind.param.stack) + "NStep" +
                                  std::to_string(kind.param.n_step);
                         });

}  // namespace
}  // namespace shoal::replay
