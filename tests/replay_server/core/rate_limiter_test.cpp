// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/rate_limiter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/random.h"

namespace shoal::replay {
namespace {

LimiterOptions Options() {
  return {.samples_per_insert = Schedule::Constant(2),
          .min_size = 10,
          .batch = 8,
          .credits = 2,
          .window_records = 6,
          .waiting_steps = 0,
          .band = 0,
          .lockstep = false};
}

TEST(RateLimiter, TheCursorAfterEachCall) {
  RateLimiter limiter(Options());
  limiter.SetSessions(1);
  // Least band: 2 * (2 * 6 + 2 * 8). Batches down to -28, inserts while the cursor is at most 16.
  EXPECT_EQ(limiter.band(), 56);
  EXPECT_FALSE(limiter.MaySample(9));
  EXPECT_TRUE(limiter.MayInsert(9));
  limiter.Inserted(10, 10, 10);
  EXPECT_EQ(limiter.cursor(), 0) << "up to min size nothing counts";
  EXPECT_TRUE(limiter.MaySample(10)) << "the learner begins at once";
  limiter.Inserted(3, 13, 13);
  EXPECT_EQ(limiter.cursor(), 6);
  limiter.Sampled();
  EXPECT_EQ(limiter.cursor(), -2);
  limiter.Sampled();
  limiter.Sampled();
  EXPECT_EQ(limiter.cursor(), -18);
  EXPECT_TRUE(limiter.MaySample(13));
  limiter.Sampled();
  EXPECT_EQ(limiter.cursor(), -26);
  EXPECT_FALSE(limiter.MaySample(13)) << "-26 - 8 is below -28";
  limiter.Inserted(3, 16, 16);
  EXPECT_EQ(limiter.cursor(), -20);
  EXPECT_TRUE(limiter.MaySample(16));
  limiter.Inserted(18, 34, 34);
  EXPECT_EQ(limiter.cursor(), 16);
  EXPECT_TRUE(limiter.MayInsert(34));
  limiter.Inserted(1, 35, 35);
  EXPECT_EQ(limiter.cursor(), 18);
  EXPECT_FALSE(limiter.MayInsert(35));
  limiter.Sampled();
  EXPECT_EQ(limiter.cursor(), 10);
  EXPECT_TRUE(limiter.MayInsert(35));
}

TEST(RateLimiter, InsertsThatCrossMinSizeCountFromThere) {
  RateLimiter limiter(Options());
  limiter.SetSessions(1);
  limiter.Inserted(12, 12, 12);
  EXPECT_EQ(limiter.cursor(), 4);
}

TEST(RateLimiter, InsertsAreNeverWithheldBelowMinSize) {
  RateLimiter limiter(Options());
  limiter.SetSessions(1);
  limiter.Inserted(40, 50, 50);
  ASSERT_FALSE(limiter.MayInsert(50));
  EXPECT_TRUE(limiter.MayInsert(9)) << "the ring has overwritten what was sampleable";
}

TEST(RateLimiter, TheBandFollowsSessionsAndRatioAndTheCursorStaysInIt) {
  RateLimiter limiter(Options());
  limiter.SetSessions(4);
  EXPECT_EQ(limiter.band(), 2 * (2 * 24 + 16));
  limiter.Inserted(32, 100, 100);
  EXPECT_EQ(limiter.cursor(), 64);
  limiter.SetSessions(1);
  EXPECT_EQ(limiter.cursor(), 28);
  limiter.SetSamplesPerInsert(Schedule::Constant(10));
  EXPECT_EQ(limiter.band(), 2 * (60 + 16));
}

TEST(RateLimiter, AWiderBandIsTakenANarrowerOneIsNot) {
  LimiterOptions options = Options();
  options.band = 1000;
  RateLimiter wide(options);
  wide.SetSessions(1);
  EXPECT_EQ(wide.band(), 1000);
  options.band = 10;
  RateLimiter narrow(options);
  narrow.SetSessions(1);
  EXPECT_EQ(narrow.band(), 56);
}

TEST(RateLimiter, TheBandHasRoomForStepsThatWaitForALaterRecord) {
  LimiterOptions options = Options();
  options.waiting_steps = 3;
  RateLimiter limiter(options);
  limiter.SetSessions(2);
  EXPECT_EQ(limiter.band(), 2 * (2 * 2 * (6 + 3) + 16));
}

TEST(RateLimiter, NoLimitMeansMinSizeOnly) {
  LimiterOptions options = Options();
  options.samples_per_insert = Schedule::Constant(0);
  RateLimiter limiter(options);
  limiter.SetSessions(1);
  for (int i = 0; i < 1000; ++i) limiter.Sampled();
  EXPECT_TRUE(limiter.MaySample(10));
  EXPECT_FALSE(limiter.MaySample(9));
  limiter.Inserted(100'000, 100'000, 100'000);
  EXPECT_TRUE(limiter.MayInsert(100'000));
}

TEST(RateLimiter, LockstepAndDrainingHoldNothingBack) {
  LimiterOptions options = Options();
  options.lockstep = true;
  RateLimiter lockstep(options);
  lockstep.SetSessions(1);
  lockstep.Inserted(1000, 1000, 1000);
  EXPECT_TRUE(lockstep.MayInsert(1000));
  EXPECT_TRUE(lockstep.MaySample(1));
  EXPECT_FALSE(lockstep.MaySample(0));

  RateLimiter draining(Options());
  draining.SetSessions(1);
  for (int i = 0; i < 10; ++i) draining.Sampled();
  ASSERT_FALSE(draining.MaySample(50));
  draining.SetDraining(true);
  EXPECT_TRUE(draining.MaySample(50));
  draining.Inserted(500, 550, 550);
  EXPECT_TRUE(draining.MayInsert(550));
  draining.SetDraining(false);
  EXPECT_FALSE(draining.MayInsert(550));
}

TEST(RateLimiter, AScheduleGrantsByTheEnvStepsStored) {
  LimiterOptions options = Options();
  options.samples_per_insert = {4, 2, 100};
  RateLimiter limiter(options);
  limiter.SetSessions(1);
  EXPECT_EQ(limiter.band(), 2 * (4 * 6 + 2 * 8));
  limiter.Inserted(14, 14, 20);
  EXPECT_DOUBLE_EQ(limiter.cursor(), 4 * (3.68 + 3.6) / 2)
      << "the last four of them, steps 16 to 20";
  for (int i = 0; i < 4; ++i) limiter.Sampled();
  const double before = limiter.cursor();
  limiter.Inserted(10, 24, 105);
  EXPECT_DOUBLE_EQ(limiter.cursor() - before, 5 * (2.1 + 2) / 2 + 5 * 2);
}

TEST(RateLimiter, AScheduleHasTheBandOfItsLargestValueWhereverThatIs) {
  LimiterOptions falling = Options(), rising = Options();
  falling.samples_per_insert = {4, 2, 100};
  rising.samples_per_insert = {2, 4, 100};
  EXPECT_EQ(RateLimiter::LeastBand(falling, 3), 2 * (3 * 4 * 6 + 2 * 8));
  EXPECT_EQ(RateLimiter::LeastBand(rising, 3), RateLimiter::LeastBand(falling, 3));
}

// Steps arrive in groups, and batches are drawn whenever this is allowed. The number of samples
// must equal a sum over the single steps, within the band.
TEST(RateLimiterProperty, SamplesPerInsertFollowAScheduleWithinTheBand) {
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    LimiterOptions options = Options();
    options.samples_per_insert = {random.Uniform(0.1, 40), random.Uniform(0.1, 40),
                                  1 + static_cast<int64_t>(random.Below(5000))};
    const Schedule& samples = options.samples_per_insert;
    RateLimiter limiter(options);
    limiter.SetSessions(1);
    uint64_t steps = 0, drawn = 0;
    double granted = 0;
    while (steps < 6000) {
      if (random.Below(2) == 0 && limiter.MayInsert(steps)) {
        const uint64_t count = 1 + random.Below(options.window_records);
        for (uint64_t i = 0; i < count; ++i, ++steps) {
          if (steps >= options.min_size) granted += (samples.At(steps) + samples.At(steps + 1)) / 2;
        }
        limiter.Inserted(count, steps, steps);
      } else if (limiter.MaySample(steps)) {
        limiter.Sampled();
        drawn += static_cast<uint64_t>(options.batch);
      }
      // Exact up to sums of doubles; nothing was clipped at an end of the band.
      ASSERT_NEAR(limiter.cursor(), granted - static_cast<double>(drawn), 1e-6)
          << "seed " << seed << ", step " << steps;
      ASSERT_LE(std::abs(granted - static_cast<double>(drawn)), limiter.band() / 2);
    }
    EXPECT_GT(drawn, 500u) << "seed " << seed;
  }
}

// One limiter with actors that have windows and a learner that always requests more. Not every
// record becomes sampleable, the ring overwrites records, processes die and restart, the ratio
// changes.
class World {
 public:
  World(const LimiterOptions& options, uint64_t seed)
      : options_(options), limiter_(options), random_(seed) {
    Scale(1 + random_.Below(4));
  }

  void Event() {
    const uint64_t kind = random_.Below(100);
    if (kind < 55) return TrySend();
    if (kind < 95) return TrySample();
    if (kind == 95) return Scale(1 + random_.Below(5));
    if (kind == 96) return Kill();
    if (kind == 97) {
      limiter_.SetSamplesPerInsert(Schedule::Constant(static_cast<double>(1 + random_.Below(64))));
    }
    if (kind == 98) sampleable_ -= std::min(sampleable_, random_.Below(200));  // overwritten
    if (kind == 99) limiter_ = Restarted();
  }

  // One side can move: a batch may be drawn, or an actor may send now or after its next credit.
  bool SomeoneCanMove() {
    Refresh();
    const bool can_send = std::ranges::any_of(actors_, [](const Actor& a) { return a.credit > 0; });
    return can_send || limiter_.MaySample(sampleable_);
  }

  bool InBand() const { return std::abs(limiter_.cursor()) <= limiter_.band() / 2; }
  uint64_t batches() const { return batches_; }
  uint64_t records() const { return records_; }

 private:
  struct Actor {
    uint64_t credit = 0;   // records it may send
    uint64_t waiting = 0;  // stored steps that are not sampleable yet
  };

  void Refresh() {
    if (!limiter_.MayInsert(sampleable_)) return;
    for (Actor& actor : actors_) actor.credit = options_.window_records;
  }

  void TrySend() {
    Refresh();
    Actor& actor = actors_[random_.Below(actors_.size())];
    if (actor.credit == 0) return;
    const uint64_t records = 1 + random_.Below(actor.credit);
    actor.waiting += random_.Below(records + 1);
    // Some wait for a later record, at most waiting_steps of them; an episode's end frees them all.
    const uint64_t wait = random_.Below(std::min(actor.waiting, options_.waiting_steps) + 1);
    const uint64_t useful = actor.waiting - wait;
    actor.waiting = wait;
    actor.credit -= records;
    records_ += records;
    sampleable_ = std::min<uint64_t>(sampleable_ + useful, 5000);
    limiter_.Inserted(useful, sampleable_, records_);
  }

  void TrySample() {
    if (!limiter_.MaySample(sampleable_)) return;
    limiter_.Sampled();
    ++batches_;
  }

  void Scale(uint64_t actors) {
    actors_.resize(actors);
    limiter_.SetSessions(static_cast<int>(actors));
  }

  // Its window is gone with it; its successor gets a new one.
  void Kill() { actors_[random_.Below(actors_.size())] = {}; }

  // The server died: what was inserted and sampled before is not remembered.
  RateLimiter Restarted() {
    LimiterOptions options = options_;
    options.samples_per_insert = limiter_.samples_per_insert();
    RateLimiter limiter(options);
    limiter.SetSessions(static_cast<int>(actors_.size()));
    return limiter;
  }

  const LimiterOptions options_;
  RateLimiter limiter_;
  Random random_;
  std::vector<Actor> actors_;
  uint64_t sampleable_ = 0, batches_ = 0, records_ = 0;
};

// Constant for even seeds, else a line that goes up or down.
Schedule SomeSchedule(Random* random, uint64_t seed) {
  const double start = static_cast<double>(random->Below(100)) / 4;
  if (seed % 2 == 0) return Schedule::Constant(start);
  return {0.1 + start, 0.1 + static_cast<double>(random->Below(400)) / 4,
          1 + static_cast<int64_t>(random->Below(20'000))};
}

TEST(RateLimiterProperty, OneSideCanAlwaysMove) {
  for (uint64_t seed = 1; seed <= 120; ++seed) {
    LimiterOptions options = Options();
    Random random(seed);
    options.samples_per_insert = SomeSchedule(&random, seed);
    options.min_size = 1 + random.Below(300);
    options.batch = 1 + static_cast<int>(random.Below(512));
    options.credits = 1 + static_cast<int>(random.Below(4));
    options.window_records = 2 + random.Below(100);
    options.waiting_steps = random.Below(3) * 50;
    World world(options, seed);
    for (int i = 0; i < 3000; ++i) {
      world.Event();
      ASSERT_TRUE(world.SomeoneCanMove()) << "seed " << seed << ", event " << i;
      ASSERT_TRUE(world.InBand()) << "seed " << seed << ", event " << i;
    }
    EXPECT_GT(world.batches(), 0u) << "seed " << seed;
    EXPECT_GT(world.records(), 300u) << "seed " << seed;
  }
}

}  // namespace
}  // namespace shoal::replay
