// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/priority_selector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "tests/replay_server/record_script.h"

namespace shoal::replay {
namespace {

using testing::ElementsAre;

constexpr uint64_t kRingRecords = 40;  // records

TEST(PriorityScale, WeightsArePowersOfPriorities) {
  for (const double exponent : {0.0, 0.25, 0.4, 0.6, 1.0}) {
    const PriorityScale proportional(PriorityKind::kProportional, exponent);
    const PriorityScale lap(PriorityKind::kLap, exponent);
    for (const float error : {0.f, 1e-4f, 0.3f, 1.f, 2.5f, 100.f, 9000.f}) {
      const auto expected = [&](double priority) {
        return static_cast<double>(PriorityScale::kOne) * std::pow(priority, exponent);
      };
      const double of_error = expected(double{error} + 1e-6);
      EXPECT_NEAR(static_cast<double>(proportional.WeightOf(error)), std::max(1.0, of_error),
                  0.51 + 1e-5 * of_error)
          << error << "^" << exponent;
      const double of_lap = expected(std::max(double{error}, 1.0));
      EXPECT_NEAR(static_cast<double>(lap.WeightOf(error)), of_lap, 0.51 + 1e-5 * of_lap)
          << error << "^" << exponent;
    }
  }
}

// Sums of a billion weights fit in 64 bits, and every sample can be drawn.
TEST(PriorityScale, WeightsHaveBounds) {
  const PriorityScale scale(PriorityKind::kProportional, 1);
  EXPECT_EQ(scale.WeightOf(0), 1u);
  EXPECT_EQ(scale.WeightOf(1e30f), PriorityScale::kMost);
  EXPECT_LE(PriorityScale::kMost, ~uint64_t{0} / 1'000'000'000);
}

// These numbers are the same on every machine.
TEST(PriorityScale, WeightsAreReproducible) {
  const PriorityScale scale(PriorityKind::kProportional, 0.6);
  std::vector<uint64_t> weights;
  for (const float error : {0.001f, 0.37f, 12.5f}) weights.push_back(scale.WeightOf(error));
  EXPECT_THAT(weights, ElementsAre(16629, 577459, 4772505));
}

// A ring with the index and the selector over it, as a server has them.
class PrioritySelectorTest : public testing::Test {
 protected:
  PrioritySelectorTest() { index_.SetSelector(&selector_); }

  // Stores an episode of `steps` steps and returns the ids of the steps.
  std::vector<uint64_t> Play(uint32_t steps) {
    std::vector<uint64_t> ids;
    for (uint32_t index = 0; index <= steps; ++index) {
      const uint8_t flags = index == steps ? kTruncated : 0;
      const auto record = MakeRecord(spec_, 0, 0, episode_, index, ++sequence_, flags);
      const RecordHeader& header = RecordLayout::Header(record.data());
      const uint64_t id = ring_.Append(0, 1, *index_.Predecessor(0, 1, header), record.data());
      index_.Added(id);
      if (index > 0) ids.push_back(id);
    }
    ++episode_;
    return ids;
  }

  // Draws often, and expects the probabilities within the 99.99 % quantile of a chi-square
  // distribution.
  void ExpectDraws(const std::map<uint64_t, double>& probabilities) {
    constexpr int kDraws = 200'000;
    std::map<uint64_t, int> counts;
    Random random(3);
    for (int i = 0; i < kDraws; ++i) {
      const Selection drawn = selector_.Draw(&random).value();
      ASSERT_TRUE(probabilities.contains(drawn.id)) << drawn.id;
      ASSERT_NEAR(drawn.probability, probabilities.at(drawn.id), 1e-5);
      ++counts[drawn.id];
    }
    double chi_square = 0;
    for (const auto& [id, p] : probabilities) {
      chi_square += std::pow(counts[id] - kDraws * p, 2) / (kDraws * p);
    }
    // Wilson and Hilferty 1931.
    const double k = static_cast<double>(probabilities.size()) - 1, part = 2 / (9 * k);
    EXPECT_LT(chi_square, k * std::pow(1 - part + 3.719 * std::sqrt(part), 3)) << k;
  }

  const ObservationSpec spec_ = TinySpec(1);
  Ring ring_{spec_, {.file = {}, .capacity = kRingRecords, .run = ""}};
  EpisodeIndex index_{ring_, {}};
  PrioritySelector selector_{ring_, index_, PriorityScale(PriorityKind::kProportional, 0.6)};
  uint64_t sequence_ = 0;
  uint32_t episode_ = 0;
};

TEST_F(PrioritySelectorTest, DrawsInProportionToPowersOfErrors) {
  const std::vector<uint64_t> ids = Play(12);
  std::map<uint64_t, double> probabilities;
  double sum = 0;
  for (size_t i = 0; i < ids.size(); ++i) {
    const float error = 0.1f * static_cast<float>(i * i);
    EXPECT_TRUE(selector_.SetError(ids[i], error));
    sum += probabilities[ids[i]] = std::pow(double{error} + 1e-6, 0.6);
  }
  for (auto& [id, p] : probabilities) p /= sum;
  ExpectDraws(probabilities);
}

TEST_F(PrioritySelectorTest, ANewSampleHasTheLargestPrioritySoFar) {
  const std::vector<uint64_t> first = Play(2);
  EXPECT_EQ(selector_.largest_priority(), 1);
  ExpectDraws({{first[0], 0.5}, {first[1], 0.5}});
  selector_.SetError(first[0], 31.f);
  selector_.SetError(first[0], 0.5f);
  const double largest = std::pow(31.0, 0.6), small = std::pow(0.5, 0.6);
  EXPECT_NEAR(selector_.largest_priority(), largest, 1e-4);
  const std::vector<uint64_t> second = Play(1);
  const double sum = small + 1 + largest;
  ExpectDraws({{first[0], small / sum}, {first[1], 1 / sum}, {second[0], largest / sum}});
}

TEST_F(PrioritySelectorTest, SamplesThatAreGoneHaveNoPriority) {
  Random random(1);
  EXPECT_FALSE(selector_.Draw(&random)) << "of an empty ring";
  const std::vector<uint64_t> old = Play(12);
  std::map<uint64_t, double> stored;
  while (ring_.Holds(old.back())) {
    for (const uint64_t id : Play(7)) stored[id] = 0;
  }
  const uint64_t reset = ring_.last_id() - 7;
  for (const uint64_t id : {old[3], reset, uint64_t{0}, ring_.last_id() + 1, ~uint64_t{0}}) {
    EXPECT_FALSE(selector_.SetError(id, 100.f)) << id;
  }
  EXPECT_EQ(selector_.largest_priority(), 1) << "an ignored error";
  std::erase_if(stored, [&](const auto& each) { return !index_.Sampleable(each.first); });
  ASSERT_EQ(stored.size(), index_.sampleable());
  for (auto& [id, p] : stored) p = 1 / static_cast<double>(stored.size());
  ExpectDraws(stored);
}

// The order in which priorities were set has no effect, only their last values.
TEST_F(PrioritySelectorTest, EqualPrioritiesGiveEqualDraws) {
  const std::vector<uint64_t> ids = Play(9);
  const auto draws = [&] {
    std::vector<uint64_t> drawn;
    Random random(8);
    for (int i = 0; i < 100; ++i) drawn.push_back(selector_.Draw(&random)->id);
    return drawn;
  };
  const auto set = [&](size_t i) { selector_.SetError(ids[i], 0.3f * static_cast<float>(i)); };
  for (size_t i = 0; i < ids.size(); ++i) set(i);
  const std::vector<uint64_t> first = draws();
  for (const uint64_t id : ids) selector_.SetError(id, 7.5f);
  EXPECT_NE(draws(), first);
  for (size_t i = ids.size(); i-- > 0;) set(i);
  EXPECT_EQ(draws(), first);
}

}  // namespace
}  // namespace shoal::replay
