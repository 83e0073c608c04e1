// SPDX-License-Identifier: Apache-2.0
// Random histories of several actors against an oracle that keeps everything.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
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
#include "tests/replay_server/oracle.h"
#include "tests/replay_server/record_script.h"
#include "tests/support/temporary_folder.h"

namespace shoal::replay {
namespace {

constexpr double kDiscount = 0.9;
constexpr double kThreshold = 1;

struct Case {
  int stack, n_step;
  std::optional<HindsightGoal> hindsight{};
  bool goal_pictures = false;
  bool end_on_success = false;
  std::optional<double> movement_share{};  // of the samples, drawn by what still moves
  MovementKind movement = MovementKind::kPath;
};

// Goals are points of the plane; the script's are spread over [-2, 2].
tasks::Task TinyTask() {
  tasks::Task::Description description;
  description.name = description.world = "Tiny";
  description.episode_length = 10;
  description.achieved_goal = {"achieved_goal", {{"x"}, {"y"}}};
  description.desired_goal = {"desired_goal", {{"x"}, {"y"}}};
  description.reward = tasks::RewardKind::kSparse;
  description.distance_threshold = kThreshold;
  return tasks::Task(description);
}

ObservationSpec SpecOf(const Case& kind) {
  const ObservationSpec spec = TinySpec(kind.stack);
  return kind.goal_pictures ? WithGoalPicture(spec) : spec;
}

// Knows what it has been told of, and tells another.
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
  History(const Case& kind, uint64_t capacity, uint64_t seed)
      : spec_(SpecOf(kind)),
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
        end_on_success_(kind.end_on_success),
        hindsight_(kind.hindsight),
        movement_share_(kind.movement_share),
        movement_kind_(kind.movement),
        random_(seed) {
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

  // Every element of a batch is what the oracle says its step looks like.
  void CheckBatch() {
    if (server_->index.sampleable() == 0) return;
    constexpr int kBatch = 16;
    UniformSelector uniform(server_->ring, server_->index);
    Selector* selector = movement_ ? static_cast<Selector*>(&*movement_) : &uniform;
    std::optional<HindsightRelabeller> relabeller;
    if (hindsight_)
      relabeller.emplace(server_->ring, server_->index, *hindsight_, /*goals_per_sample=*/4);
    const auto plan =
        DrawPlan({.batch = kBatch}, selector, relabeller ? &*relabeller : nullptr, &random_);
    ASSERT_TRUE(plan.has_value());
    const BatchSchema schema(spec_, {.batch = kBatch, .privileged = privileged_});
    const AlignedBytes memory(schema.total_bytes());
    const BatchView view = schema.View(memory.data());
    BatchGather(server_->ring, server_->index, spec_,
                {.steps = oracle_.n_step, .discount = kDiscount}, &goals_, privileged_)
        .Gather(*plan, view);
    for (size_t b = 0; b < kBatch; ++b) CheckElement(plan->elements[b], b, view);
    if (movement_share_) CheckProbabilities(*plan);
  }

  const RecordHeader& HeaderOf(uint64_t id) const { return oracle_.all[id - 1].header(); }
  uint64_t stored() const { return oracle_.all.size(); }
  uint64_t first_frame_repeats() const { return first_frame_repeats_; }
  // Samples of fewer steps, because the last one terminated the episode.
  uint64_t short_samples() const { return short_samples_; }
  // Samples with a goal of hindsight, and with one achieved before the sample began.
  uint64_t relabelled() const { return relabelled_; }
  uint64_t goals_before() const { return goals_before_; }
  // Steps that are stored with all that they need but their episode's goal record.
  uint64_t without_goal() const { return without_goal_; }
  uint64_t restarts() const { return restarts_; }
  // Samples with a goal of hindsight that a step ended because it reached that goal, and steps that
  // ended their episode but not under that goal.
  uint64_t ended_by_goal() const { return ended_by_goal_; }
  uint64_t went_on() const { return went_on_; }

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
    if (movement_share_) {
      movement_.emplace(server_->ring, server_->index, goals_, *movement_share_, movement_kind_);
      kept_.other = &*movement_;
    }
    server_->index.SetSelector(&kept_);
  }

  // Another server goes on with the file.
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

  // A server takes over, and the actor keeps `count` records no more that it does not know.
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

  void CheckElement(const BatchPlan::Element& element, size_t b, const BatchView& view) {
    const uint64_t id = element.id;
    if (element.goal != 0) CheckGoal(element);
    ASSERT_TRUE(oracle_.Sampleable(id)) << "record " << id;
    std::vector<uint64_t> steps = *oracle_.Steps(id);
    const bool terminated = EndUnderGoal(&steps, element.goal);
    const Oracle::Stored &first = oracle_.all[id - 1], &last = oracle_.all[steps.back() - 1];
    const Oracle::Stored& before = oracle_.all[first.prev - 1];
    double reward = 0;
    for (size_t k = 0; k < steps.size(); ++k) {
      const Oracle::Stored& step = oracle_.all[steps[k] - 1];
      reward += std::pow(kDiscount, k) * Earned(step, element.goal);
      CheckContinues(oracle_.all[step.prev - 1], last);
    }
    const uint64_t shown = element.goal != 0 ? element.goal : oracle_.Episode(id).front();
    CheckInput(*oracle_.Stack(first.prev), shown, view.obs_frames, b);
    CheckInput(*oracle_.Stack(steps.back()), shown, view.next_obs_frames, b);
    if (steps.size() < static_cast<size_t>(oracle_.n_step)) ++short_samples_;
    if (before.header().index == 0) ++first_frame_repeats_;
    ASSERT_FLOAT_EQ(view.reward[b], static_cast<float>(reward));
    ASSERT_EQ(view.weights_update[b], first.header().weights_update);
    ASSERT_EQ(view.id[b], id);
    const double bootstrap = terminated ? 0 : std::pow(kDiscount, steps.size() - 1);
    ASSERT_FLOAT_EQ(view.bootstrap[b], static_cast<float>(bootstrap));
    ExpectFloats(layout_.Action(first.bytes.data()), view.action, b);
    ExpectFloats(Observed(before, element.goal), view.obs_vector, b);
    ExpectFloats(Observed(last, element.goal), view.next_obs_vector, b);
    if (!spec_.goal_picture) return;
    ExpectFloats(Wanted(before, element.goal), view.obs_privileged, b);
    ExpectFloats(Wanted(last, element.goal), view.next_obs_privileged, b);
  }

  // Cuts a sample off behind the first step that ends the episode under the goal; whether one does.
  bool EndUnderGoal(std::vector<uint64_t>* steps, uint64_t goal) {
    for (size_t k = 0; k < steps->size(); ++k) {
      const Oracle::Stored& step = oracle_.all[(*steps)[k] - 1];
      const bool ended = (step.header().flags & kTerminated) != 0;
      const bool ends = goal == 0 || !end_on_success_ ? ended : EndsUnderGoal(step, goal);
      went_on_ += ended && !ends ? 1 : 0;
      if (!ends) continue;
      ended_by_goal_ += ended ? 0 : 1;
      steps->resize(k + 1);
      return true;
    }
    return false;
  }

  // An episode that the world ended has ended under every goal.
  bool EndsUnderGoal(const Oracle::Stored& step, uint64_t goal) const {
    return (step.header().flags & (kTerminated | kSuccess)) == kTerminated ||
           Distance(step, goal) < kThreshold;
  }

  // Whatever was overwritten, cut off or read anew: half by what still moves, half uniformly.
  void CheckProbabilities(const BatchPlan& plan) {
    std::map<uint64_t, double> movements;
    double all = 0;
    for (const uint64_t id : kept_.ids) all += movements[id] = Movement(id);
    ASSERT_GT(all, 0);
    for (const BatchPlan::Element& element : plan.elements) {
      const double expected = (1 - *movement_share_) / static_cast<double>(movements.size()) +
                              *movement_share_ * movements.at(element.id) / all;
      ASSERT_NEAR(element.probability, expected, 1e-5 * expected) << "record " << element.id;
    }
  }

  // Movement of the achieved goal from that step to its episode's end.
  double Movement(uint64_t id) const {
    const auto achieved = [&](uint64_t record) {
      return layout_.Vector(oracle_.all[record - 1].bytes.data()).subspan(2, 2);
    };
    const auto distance = [&](uint64_t from, uint64_t to) {
      return std::hypot(double{achieved(to)[0]} - achieved(from)[0],
                        double{achieved(to)[1]} - achieved(from)[1]);
    };
    const std::vector<uint64_t> episode = oracle_.Episode(id);
    if (movement_kind_ == MovementKind::kDisplacement) {
      return distance(oracle_.all[id - 1].prev, episode.back());
    }
    double path = 0;
    for (const uint64_t step : episode) {
      if (step >= id) path += distance(oracle_.all[step - 1].prev, step);
    }
    return path;
  }

  bool LacksItsGoalAlone(uint64_t id) const {
    return spec_.goal_picture && oracle_.Steps(id) && !oracle_.Holds(oracle_.Episode(id).front()) &&
           oracle_.Stack(oracle_.all[id - 1].prev);
  }

  // The goal is a stored one of the same episode, at a step that the kind of hindsight allows.
  void CheckGoal(const BatchPlan::Element& element) {
    ++relabelled_;
    const std::vector<uint64_t> episode = oracle_.Episode(element.id);
    ASSERT_TRUE(std::ranges::count(episode, element.goal) == 1 && oracle_.Holds(element.goal));
    ASSERT_NE(oracle_.all[element.goal - 1].header().index, 0u) << "a reset is nothing achieved";
    ASSERT_TRUE(*hindsight_ != HindsightGoal::kFuture || element.goal >= element.id);
    ASSERT_TRUE(*hindsight_ != HindsightGoal::kFinal || element.goal == episode.back());
    if (element.goal < element.id) ++goals_before_;
  }

  // Sparse, against the goal of record `goal`, if that is one.
  float Earned(const Oracle::Stored& step, uint64_t goal) const {
    if (goal == 0) return step.header().reward;
    return Distance(step, goal) > kThreshold ? -1.0f : 0.0f;
  }
  double Distance(const Oracle::Stored& step, uint64_t goal) const {
    const auto achieved = layout_.Vector(step.bytes.data()).subspan(2, 2);
    const auto wanted = layout_.Vector(oracle_.all[goal - 1].bytes.data()).subspan(2, 2);
    const double x = double{achieved[0]} - wanted[0], y = double{achieved[1]} - wanted[1];
    return std::sqrt(x * x + y * y);
  }

  // The script has three blocks of 2 numbers. The second, the achieved goal, is recorded only; so
  // is the third, the desired goal, if a picture shows it.
  std::vector<float> Observed(const Oracle::Stored& stored, uint64_t goal) const {
    const auto all = layout_.Vector(stored.bytes.data());
    std::vector<float> observed{all[0], all[1]};
    if (spec_.goal_picture) return observed;
    const std::vector<float> wanted = Wanted(stored, goal);
    observed.insert(observed.end(), wanted.begin(), wanted.end());
    return observed;
  }
  std::vector<float> Wanted(const Oracle::Stored& stored, uint64_t goal) const {
    const auto of_goal =
        layout_.Vector(goal == 0 ? stored.bytes.data() : oracle_.all[goal - 1].bytes.data());
    const auto wanted = of_goal.subspan(goal == 0 ? 4 : 2, 2);
    return {wanted.begin(), wanted.end()};
  }

  // Never across an episode's end: `before` is of the same episode and did not end it.
  void CheckContinues(const Oracle::Stored& before, const Oracle::Stored& last) {
    ASSERT_EQ(before.header().env, last.header().env);
    ASSERT_EQ(before.header().episode, last.header().episode);
    ASSERT_EQ(before.header().flags & (kTerminated | kTruncated), 0);
  }

  // `newest_first` ids, and the one that shows the goal, against element b of `frames`, which has
  // the oldest frame first and the goal last.
  void CheckInput(std::vector<uint64_t> newest_first, uint64_t goal,
                  std::span<const uint8_t> frames, size_t b) {
    const size_t frame_bytes = static_cast<size_t>(layout_.frame_bytes());
    std::vector<uint64_t> ids(newest_first.rbegin(), newest_first.rend());
    if (spec_.goal_picture) ids.push_back(goal);
    for (size_t k = 0; k < ids.size(); ++k) {
      const auto expected = layout_.Frame(oracle_.all[ids[k] - 1].bytes.data());
      const auto actual = frames.subspan((b * ids.size() + k) * frame_bytes, frame_bytes);
      ASSERT_TRUE(std::ranges::equal(expected, actual)) << "frame " << k << " of element " << b;
    }
  }

  void ExpectFloats(std::span<const float> expected, std::span<const float> all, size_t b) {
    ASSERT_TRUE(std::ranges::equal(expected, all.subspan(b * expected.size(), expected.size())));
  }

  const ObservationSpec spec_;
  const RecordLayout layout_;
  const TemporaryFolder folder_;
  const RingOptions ring_options_;
  const IndexOptions index_options_;
  Oracle oracle_;
  const Names privileged_;
  const bool end_on_success_;
  const GoalChange goals_{spec_, TinyTask(), privileged_, end_on_success_};
  const std::optional<HindsightGoal> hindsight_;
  const std::optional<double> movement_share_;
  const MovementKind movement_kind_;
  KeptSelector kept_;
  std::unique_ptr<Server> server_;
  std::optional<MovementSelector> movement_;  // over the server's ring
  Random random_;
  std::vector<Actor> actors_;  // the newest session of each
  uint64_t last_session_ = 0;
  uint64_t first_frame_repeats_ = 0, short_samples_ = 0, relabelled_ = 0, goals_before_ = 0,
           without_goal_ = 0, restarts_ = 0, ended_by_goal_ = 0, went_on_ = 0;
};

class ReplayProperty : public testing::TestWithParam<Case> {};

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
    EXPECT_GT(history.first_frame_repeats(), 0u);
    EXPECT_EQ(history.short_samples() > 0, GetParam().n_step > 1);
    EXPECT_EQ(history.relabelled() > 0, GetParam().hindsight.has_value());
    EXPECT_EQ(history.goals_before() > 0, GetParam().hindsight == HindsightGoal::kEpisode);
    EXPECT_EQ(history.without_goal() > 0, GetParam().goal_pictures);
    EXPECT_EQ(history.ended_by_goal() > 0, GetParam().end_on_success);
    // A goal that lies ahead is reached in the sample that has the episode's last step.
    EXPECT_EQ(history.went_on() > 0,
              GetParam().end_on_success && GetParam().hindsight == HindsightGoal::kEpisode);
    EXPECT_GT(history.restarts(), 2u);
  }
}

std::string CaseName(const testing::TestParamInfo<Case>& info) {
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
        Case{1, 1}, Case{2, 1}, Case{3, 1}, Case{1, 3}, Case{3, 2},
        Case{1, 1, HindsightGoal::kFuture}, Case{2, 3, HindsightGoal::kFuture},
        Case{1, 1, HindsightGoal::kFinal}, Case{3, 1, HindsightGoal::kEpisode},
        Case{1, 1, {}, true}, Case{3, 2, {}, true}, Case{1, 1, HindsightGoal::kFuture, true},
        Case{2, 3, HindsightGoal::kEpisode, true}, Case{1, 1, HindsightGoal::kFuture, false, true},
        Case{2, 3, HindsightGoal::kFuture, false, true},
        Case{1, 2, HindsightGoal::kFinal, false, true},
        Case{2, 1, HindsightGoal::kEpisode, false, true},
        Case{1, 4, HindsightGoal::kEpisode, true, true},
        Case{1, 1, HindsightGoal::kFuture, false, false, 0.5},
        Case{2, 3, HindsightGoal::kFinal, true, true, 1},
        Case{1, 1, HindsightGoal::kFuture, false, false, 0.5, MovementKind::kDisplacement},
        Case{2, 3, HindsightGoal::kFinal, true, true, 1, MovementKind::kDisplacement}),
    CaseName);

}  // namespace
}  // namespace shoal::replay
