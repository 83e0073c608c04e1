// SPDX-License-Identifier: Apache-2.0
// Compares random histories of several actors with an oracle that keeps every record.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/base/aligned_bytes.h"
#include "replay_server/core/hindsight.h"
#include "replay_server/core/movement_selector.h"
#include "replay_server/core/replay_core.h"
#include "replay_server/core/uniform_selector.h"
#include "tests/replay_server/core/batch_oracle.h"
#include "tests/replay_server/core/replay_case.h"
#include "tests/replay_server/oracle.h"
#include "tests/replay_server/record_script.h"
#include "tests/support/temporary_folder.h"

namespace shoal::replay {
namespace {

// Records the ids added and removed, and forwards them to another selector.
class KeptSelector final : public Selector {
 public:
  void Added(uint64_t id) override {
    EXPECT_TRUE(ids.insert(id).second) << id;
    if (other) other->Added(id);
  }
  void Removed(uint64_t id) override {
    EXPECT_EQ(ids.erase(id), 1u) << id;
    if (other) other->Removed(id);
  }
  std::optional<Selection> Draw(Random*) override { return std::nullopt; }
  uint64_t redraws() const override { return 0; }

  std::set<uint64_t> ids;
  Selector* other = nullptr;
};

// The parts of a replay server over a ring in a file.
struct Server {
  Server(const ObservationSpec& spec, const RingOptions& ring_options, const IndexOptions& options)
      : ring(spec, ring_options),
        sessions(ring.sessions()),
        index(ring, options),
        intake(spec.Hash(), &ring, &sessions, &index) {}

  Ring ring;
  SessionTable sessions;
  EpisodeIndex index;
  Intake intake;
};

// Drives a server with what actors do and what goes wrong on the way.
class History {
 public:
  History(const ReplayCase& kind, uint64_t capacity, uint64_t seed)
      : kind_(kind),
        spec_(SpecOf(kind)),
        layout_(spec_),
        ring_options_{.file = folder_.path() / "ring", .capacity = capacity, .run = "history"},
        index_options_{.stack = kind.stack,
                       .n_step = kind.n_step,
                       .whole_episodes = kind.hindsight.has_value(),
                       .goal_pictures = kind.goal_pictures},
        oracle_{.capacity = capacity,
                .stack = kind.stack,
                .n_step = kind.n_step,
                .whole_episodes = kind.hindsight.has_value(),
                .goal_pictures = kind.goal_pictures},
        privileged_(kind.goal_pictures ? Names{"desired_goal"} : Names{}),
        random_(seed),
        draws_(seed + 100) {
    StartServer();
    for (uint32_t actor = 0; actor < 3; ++actor) StartSession(actor);
  }

  void Event() {
    Actor& actor = actors_[random_.Below(actors_.size())];
    const uint64_t kind = random_.Below(40);
    const uint32_t count = 1 + static_cast<uint32_t>(random_.Below(6));
    if (kind == 0) return StartSession(actor.script->actor());
    if (kind == 1) return LoseSome(&actor, count);
    if (kind == 2) actor.script->Spoil(actor.next + random_.Below(count));
    if (kind == 3) RestartServer();
    // Now and then from before what is stored already: duplicates.
    const uint64_t back = kind < 8 ? random_.Below(actor.next) : 0;
    Deliver(&actor, actor.next - back, count + static_cast<uint32_t>(back));
  }

  void Check() {
    uint64_t sampleable = 0;
    for (uint64_t id = 1; id <= oracle_.all.size(); ++id) {
      ASSERT_EQ(server_->index.Sampleable(id), oracle_.Sampleable(id)) << "record " << id;
      sampleable += oracle_.Sampleable(id) ? 1 : 0;
      without_goal_ += LacksItsGoalAlone(id) ? 1 : 0;
      ASSERT_EQ(kept_.ids.contains(id), oracle_.Sampleable(id)) << "told of record " << id;
    }
    ASSERT_EQ(server_->index.sampleable(), sampleable);
    ASSERT_EQ(server_->ring.last_id(), oracle_.all.size());
    for (const Actor& actor : actors_) CheckCounters(actor);
  }

  // Every element of a batch must equal the oracle's step.
  void CheckBatch() {
    if (server_->index.sampleable() == 0) return;
    constexpr int kBatch = 16;
    UniformSelector uniform(server_->ring, server_->index);
    Selector* selector = movement_ ? static_cast<Selector*>(&*movement_) : &uniform;
    std::optional<HindsightRelabeller> relabeller;
    if (kind_.hindsight) {
      relabeller.emplace(server_->ring, server_->index, *kind_.hindsight, /*goals_per_sample=*/4);
    }
    const auto plan = DrawPlan({.batch = kBatch, .horizon = oracle_.n_step}, selector,
                               relabeller ? &*relabeller : nullptr, &draws_);
    ASSERT_TRUE(plan.has_value());
    const BatchSchema schema(
        spec_, {.batch = kBatch, .horizon = oracle_.n_step, .privileged = privileged_});
    const AlignedBytes memory(schema.total_bytes());
    const BatchView view = schema.View(memory.data());
    BatchGather(server_->ring, server_->index, spec_,
                {.steps = oracle_.n_step, .discount = kDiscount}, &goals_, privileged_)
        .Gather(*plan, view);
    for (size_t b = 0; b < kBatch; ++b) {
      batches_.CheckElement(plan->elements[b], b, view);
      CheckSequence(b, view);
    }
    if (kind_.movement_share) batches_.CheckProbabilities(*plan, kept_.ids);
  }

  uint64_t stored() const { return oracle_.all.size(); }
  const BatchOracle::Counts& batches() const { return batches_.counts(); }
  // Steps that are stored with all that they need but their episode's goal record.
  uint64_t without_goal() const { return without_goal_; }
  uint64_t restarts() const { return restarts_; }

 private:
  using Names = std::vector<std::string>;

  struct Actor {
    std::unique_ptr<RecordScript> script;
    uint64_t next = 1;  // first sequence not dealt with
    uint64_t lost = 0;
    Oracle::Counts counts{};
  };

  void StartServer() {
    server_ = std::make_unique<Server>(spec_, ring_options_, index_options_);
    kept_ = {};
    if (kind_.movement_share) {
      movement_.emplace(server_->ring, server_->index, goals_, *kind_.movement_share,
                        kind_.movement);
      kept_.other = &*movement_;
    }
    server_->index.SetSelector(&kept_);
  }

  // Another server continues with the file.
  void RestartServer() {
    server_.reset();
    StartServer();
    oracle_.ReadAnew();
    ++restarts_;
  }

  void StartSession(uint32_t actor) {
    auto script = std::make_unique<RecordScript>(spec_, actor, ++last_session_);
    if (actor == actors_.size()) actors_.emplace_back();
    actors_[actor] = {.script = std::move(script)};
  }

  void Deliver(Actor* actor, uint64_t first, uint32_t count) {
    const ChunkResult result = server_->intake.Take(actor->script->Chunk(first, count));
    ASSERT_EQ(result.fate, ChunkFate::kDealtWith);
    ASSERT_EQ(result.duplicates, std::min<uint64_t>(count, actor->next - first));
    for (; actor->next < first + count; ++actor->next) {
      oracle_.Take(layout_, actor->script->actor(), actor->script->session(),
                   actor->script->At(actor->next), &actor->counts);
    }
  }

  // A new server takes over, and the actor no longer has `count` of the records that the server
  // lacks.
  void LoseSome(Actor* actor, uint32_t count) {
    const uint64_t first = actor->next + count;
    RestartServer();
    ASSERT_EQ(server_->intake.Take(actor->script->Chunk(first, 3)).fate, ChunkFate::kAhead);
    TransitionChunk position = actor->script->Chunk(first, 1);
    position.count = 0;
    position.payload = {};
    ASSERT_EQ(server_->intake.Take(position).lost, count);
    actor->next = first;
    actor->lost += count;
    Deliver(actor, first, 3);
  }

  void CheckCounters(const Actor& actor) {
    const auto i = server_->sessions.Find(actor.script->actor(), actor.script->session());
    ASSERT_EQ(i.has_value(), actor.next > 1);
    if (!i) return;
    const SessionCounters& counters = server_->sessions.at(*i);
    ASSERT_EQ(counters.highest, actor.next - 1);
    ASSERT_EQ(counters.stored(), actor.counts.stored);
    ASSERT_EQ(counters.rejected, actor.counts.rejected);
    ASSERT_EQ(counters.after_gap, actor.counts.after_gap);
    ASSERT_EQ(counters.lost, actor.lost);
    ASSERT_EQ(actor.counts.stored + actor.counts.rejected + actor.counts.after_gap + actor.lost,
              counters.highest);
  }

  // The steps of a sequence must add up to the sample, which agrees with the oracle. No picture is
  // shifted.
  static void CheckSequence(size_t b, const BatchView& batch) {
    const auto row = [&](auto array) {
      const size_t size = array.size() / batch.rows();
      return array.subspan(b * size, size);
    };
    double reward = 0, discount = 1;
    size_t last = 0;
    for (size_t h = 0; h < batch.steps.size() && batch.steps[h].present[b] == 1; ++h) {
      if (h > 0) discount *= kDiscount;
      reward += discount * batch.steps[h].reward[b];
      last = h;
    }
    const StepView& end = batch.steps[last];
    ASSERT_FLOAT_EQ(static_cast<float>(reward), batch.reward[b]);
    ASSERT_EQ(end.terminated[b] == 1 ? 0 : static_cast<float>(discount), batch.bootstrap[b]);
    ASSERT_TRUE(std::ranges::equal(row(end.next_frames), row(batch.next_obs_frames)));
    ASSERT_TRUE(std::ranges::equal(row(end.next_vector), row(batch.next_obs_vector)));
    ASSERT_TRUE(std::ranges::equal(row(batch.steps[0].action), row(batch.action)));
    for (size_t h = last + 1; h < batch.steps.size(); ++h) {
      ASSERT_EQ(batch.steps[h].present[b], 0);
    }
  }

  bool LacksItsGoalAlone(uint64_t id) const {
    return spec_.goal_picture && oracle_.Steps(id) && !oracle_.Holds(oracle_.Episode(id).front()) &&
           oracle_.Stack(oracle_.all[id - 1].prev);
  }

  const ReplayCase kind_;
  const ObservationSpec spec_;
  const RecordLayout layout_;
  const TemporaryFolder folder_;
  const RingOptions ring_options_;
  const IndexOptions index_options_;
  Oracle oracle_;
  const Names privileged_;
  const GoalChange goals_{spec_, TinyTask(), privileged_, kind_.end_on_success};
  BatchOracle batches_{kind_, oracle_};
  KeptSelector kept_;
  std::unique_ptr<Server> server_;
  std::optional<MovementSelector> movement_;  // over the server's ring
  Random random_, draws_;                     // of the events, and of the batches
  std::vector<Actor> actors_;                 // the newest session of each
  uint64_t last_session_ = 0;
  uint64_t without_goal_ = 0, restarts_ = 0;
};

class ReplayProperty : public testing::TestWithParam<ReplayCase> {};

TEST_P(ReplayProperty, AgreesWithAnOracleThatKeepsEverything) {
  for (const uint64_t seed : {1, 2, 3, 4}) {
    History history(GetParam(), /*capacity=*/20 + 17 * seed, seed);
    for (int i = 0; i < 150; ++i) {
      history.Event();
      history.Check();
      history.CheckBatch();
      ASSERT_FALSE(HasFatalFailure()) << "seed " << seed << ", event " << i;
    }
    EXPECT_GT(history.stored(), 300u);
    EXPECT_GT(history.batches().first_frame_repeats, 0u);
    EXPECT_EQ(history.batches().short_samples > 0, GetParam().n_step > 1);
    EXPECT_EQ(history.batches().relabelled > 0, GetParam().hindsight.has_value());
    EXPECT_EQ(history.batches().goals_before > 0, GetParam().hindsight == HindsightGoal::kEpisode);
    EXPECT_EQ(history.without_goal() > 0, GetParam().goal_pictures);
    EXPECT_EQ(history.batches().ended_by_goal > 0, GetParam().end_on_success);
    // A goal that lies ahead is reached in the sample that has the episode's last step.
    EXPECT_EQ(history.batches().went_on > 0,
              GetParam().end_on_success && GetParam().hindsight == HindsightGoal::kEpisode);
    EXPECT_GT(history.restarts(), 2u);
  }
}

std::string CaseName(const testing::TestParamInfo<ReplayCase>& info) {
  static constexpr const char* kNames[] = {"Future", "Final", "Episode"};
  const auto& [stack, n_step, hindsight, goal_pictures, end_on_success, movement_share, movement] =
      info.param;
  return "Stack" + std::to_string(stack) + "NStep" + std::to_string(n_step) +
         (hindsight ? kNames[static_cast<int>(*hindsight)] : "") +
         (goal_pictures ? "GoalPictures" : "") + (end_on_success ? "EndOnSuccess" : "") +
         (!movement_share                           ? ""
          : movement == MovementKind::kDisplacement ? "Displacement"
                                                    : "Movement");
}

INSTANTIATE_TEST_SUITE_P(
    StacksAndSteps, ReplayProperty,
    testing::Values(
        ReplayCase{1, 1}, ReplayCase{2, 1}, ReplayCase{3, 1}, ReplayCase{1, 3}, ReplayCase{3, 2},
        ReplayCase{1, 1, HindsightGoal::kFuture}, ReplayCase{2, 3, HindsightGoal::kFuture},
        ReplayCase{1, 1, HindsightGoal::kFinal}, ReplayCase{3, 1, HindsightGoal::kEpisode},
        ReplayCase{1, 1, {}, true}, ReplayCase{3, 2, {}, true},
        ReplayCase{1, 1, HindsightGoal::kFuture, true},
        ReplayCase{2, 3, HindsightGoal::kEpisode, true},
        ReplayCase{1, 1, HindsightGoal::kFuture, false, true},
        ReplayCase{2, 3, HindsightGoal::kFuture, false, true},
        ReplayCase{1, 2, HindsightGoal::kFinal, false, true},
        ReplayCase{2, 1, HindsightGoal::kEpisode, false, true},
        ReplayCase{1, 4, HindsightGoal::kEpisode, true, true},
        ReplayCase{1, 1, HindsightGoal::kFuture, false, false, 0.5},
        ReplayCase{2, 3, HindsightGoal::kFinal, true, true, 1},
        ReplayCase{1, 1, HindsightGoal::kFuture, false, false, 0.5, MovementKind::kDisplacement},
        ReplayCase{2, 3, HindsightGoal::kFinal, true, true, 1, MovementKind::kDisplacement}),
    CaseName);

}  // namespace
}  // namespace shoal::replay
