// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/movement_selector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "common/tasks/task_registry.h"
#include "tests/replay_server/record_script.h"

namespace shoal::replay {
namespace {

constexpr uint32_t kSteps = 5;  // of an episode
constexpr uint64_t kRoom = 40;  // records

ObservationSpec PushSpec() {
  ObservationSpec spec;
  spec.task = "FetchPush";
  spec.blocks = {{"achieved_goal", 3, /*observed=*/false}, {"desired_goal", 3}};
  spec.action_size = 4;
  return spec;
}

// A ring with the index and the selector over it, as a server has them.
struct Stored {
  Stored(double share, const Ring& ring, MovementKind movement = MovementKind::kPath)
      : kind(movement),
        index(ring, {.whole_episodes = true}),
        selector(ring, index, goals, share, kind) {
    index.SetSelector(&selector);
  }

  const MovementKind kind;
  const GoalChange goals{PushSpec(), tasks::FindTask("FetchPush")};
  EpisodeIndex index;
  MovementSelector selector;
};

class MovementSelectorTest : public testing::Test {
 protected:
  // An episode in whose step k the object moves `moves[k - 1]` metres along x.
  void Play(Stored* stored, const std::vector<double>& moves) {
    double x = 1.3;
    for (uint32_t index = 0; index <= moves.size(); ++index) {
      if (index > 0) x += moves[index - 1];
      const uint8_t flags = index == moves.size() ? kTruncated : 0;
      auto record = MakeRecord(spec_, 0, 0, episode_, index, ++sequence_, flags);
      const auto vector = RecordLayout(spec_).Vector(record.data());
      vector[0] = static_cast<float>(x);
      vector[1] = vector[2] = 0.5f;
      const RecordHeader& header = RecordLayout::Header(record.data());
      const uint64_t id =
          ring_.Append(0, 1, *stored->index.Predecessor(0, 1, header), record.data());
      stored->index.Added(id);
    }
    ++episode_;
  }

  // How far the object moves from each sampleable step to the end of its episode, by the records.
  std::map<uint64_t, double> Movements(const Stored& stored) {
    std::map<uint64_t, double> movements;
    for (uint64_t id = ring_.oldest_id(); id <= ring_.last_id(); ++id) {
      if (!stored.index.Sampleable(id)) continue;
      double path = 0, from_start = 0;
      for (uint64_t step = id; step != 0; step = stored.index.Next(step)) {
        const auto x = [&](uint64_t record) {
          return double{stored.goals.Achieved(ring_.Record(record))[0]};
        };
        path += std::abs(x(step) - x(stored.index.Previous(step)));
        from_start = std::abs(x(step) - x(stored.index.Previous(id)));
      }
      movements[id] = stored.kind == MovementKind::kPath ? path : from_start;
    }
    return movements;
  }

  // Each sampleable step is drawn with probability (1 - share) / n + share movement / all
  // movements, within 5 sigma of a binomial, and the selector reports this probability.
  void CheckDraws(double share, Stored* stored) {
    constexpr int kDraws = 200'000;
    const std::map<uint64_t, double> movements = Movements(*stored);
    double all = 0;
    for (const auto& [id, movement] : movements) all += movement;
    std::map<uint64_t, int> counts;
    Random random(3);
    for (int i = 0; i < kDraws; ++i) {
      const Selection drawn = stored->selector.Draw(&random).value();
      ++counts[drawn.id];
      ASSERT_TRUE(movements.contains(drawn.id)) << drawn.id;
      const double p = (1 - share) / static_cast<double>(movements.size()) +
                       share * movements.at(drawn.id) / all;
      ASSERT_NEAR(drawn.probability, p, 1e-4 * p) << drawn.id;
    }
    for (const auto& [id, movement] : movements) {
      const double p = (1 - share) / static_cast<double>(movements.size()) + share * movement / all;
      EXPECT_NEAR(counts[id], kDraws * p, 5 * std::sqrt(kDraws * p * (1 - p)) + 1e-9) << id;
    }
  }

  const ObservationSpec spec_ = PushSpec();
  Ring ring_{spec_, {.file = {}, .capacity = kRoom, .run = ""}};
  uint64_t sequence_ = 0;
  uint32_t episode_ = 0;
};

TEST_F(MovementSelectorTest, DrawsByHowFarTheObjectStillMoves) {
  for (const double share : {1.0, 0.5}) {
    Stored stored(share, ring_);
    Play(&stored, {0, 0.01, 0.02, 0, 0});
    Play(&stored, {0, 0, 0, 0, 0});
    Play(&stored, {0.03, 0, -0.03, 0.1, 0});
    CheckDraws(share, &stored);
  }
}

// An object that goes back to where it was is displaced by nothing from its first step on.
TEST_F(MovementSelectorTest, DrawsByHowFarFromThereTheObjectEnds) {
  for (const double share : {1.0, 0.5}) {
    Stored stored(share, ring_, MovementKind::kDisplacement);
    Play(&stored, {0, 0.01, 0.02, 0, 0});
    Play(&stored, {0.05, -0.05, 0.05, -0.05, 0});
    Play(&stored, {0.03, 0, -0.03, 0.1, 0});
    CheckDraws(share, &stored);
  }
}

class MovementSelectorKinds : public MovementSelectorTest,
                              public testing::WithParamInterface<MovementKind> {};

TEST_P(MovementSelectorKinds, WhatIsOverwrittenIsDrawnNoMore) {
  Stored stored(1, ring_, GetParam());
  for (int i = 0; i < 20; ++i) Play(&stored, {0.01 * (i % 3), 0, 0.02, 0, 0.001 * i});
  ASSERT_GT(ring_.oldest_id(), 1u);
  CheckDraws(1, &stored);
}

TEST_F(MovementSelectorTest, WhereNothingMovesAllAreDrawnEquallyOften) {
  Stored stored(1, ring_);
  Play(&stored, std::vector<double>(kSteps));
  std::set<uint64_t> drawn;
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const auto selection = stored.selector.Draw(&random);
    ASSERT_TRUE(selection.has_value());
    EXPECT_DOUBLE_EQ(selection->probability, 1.0 / kSteps);
    drawn.insert(selection->id);
  }
  EXPECT_EQ(drawn.size(), kSteps);
}

TEST_F(MovementSelectorTest, FindsNothingWhereNothingIs) {
  Stored stored(0.5, ring_);
  Random random(1);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(stored.selector.Draw(&random).has_value());
}

// Also of the episode that is partly overwritten.
TEST_P(MovementSelectorKinds, AServerThatStartsAgainDrawsTheSameSteps) {
  Stored before(0.7, ring_, GetParam());
  for (int i = 0; i < 9; ++i) Play(&before, {0.01, 0, 0.001 * i, 0.02, 0});
  ASSERT_GT(ring_.oldest_id(), 1u);
  Stored after(0.7, ring_, GetParam());
  Random a(5), b(5);
  for (int i = 0; i < 1000; ++i) {
    const Selection first = before.selector.Draw(&a).value();
    const Selection second = after.selector.Draw(&b).value();
    ASSERT_EQ(first.id, second.id);
    ASSERT_EQ(first.probability, second.probability);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, MovementSelectorKinds,
                         testing::Values(MovementKind::kPath, MovementKind::kDisplacement),
                         [](const auto& kind) {
                           return kind.param == MovementKind::kPath ? "Path" : "Displacement";
                         });

// Records of a faulty world neither stop the server nor get all draws.
TEST_F(MovementSelectorTest, WhatIsNoNumberCountsAsTenMetres) {
  Stored stored(1, ring_);
  Play(&stored, {0, std::numeric_limits<double>::infinity(), 0});
  Play(&stored, {10, 0, 0});
  Random random(1);
  std::map<uint64_t, int> counts;
  for (int i = 0; i < 6000; ++i) ++counts[stored.selector.Draw(&random).value().id];
  // Steps 1 and 2 of the first episode (inf - inf in step 3 counts as well) and step 1 of the
  // other: 20, 20, 10 and 10 metres to come.
  EXPECT_EQ(counts.size(), 4u);
  EXPECT_NEAR(counts[2], 2000, 200);
  EXPECT_NEAR(counts[6], 1000, 150);
}

}  // namespace
}  // namespace shoal::replay
