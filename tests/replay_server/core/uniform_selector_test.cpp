// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/uniform_selector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "tests/replay_server/record_script.h"

namespace shoal::replay {
namespace {

// Draws one time in twenty the lower of two ids: what a subtly wrong selector looks like.
class BiasedSelector : public Selector {
 public:
  explicit BiasedSelector(Selector* inner) : inner_(*inner) {}
  void Added(uint64_t) override {}
  void Removed(uint64_t) override {}
  std::optional<Selection> Draw(Random* random) override {
    const auto first = inner_.Draw(random);
    if (random->Below(20) != 0) return first;
    const auto second = inner_.Draw(random);
    return first->id < second->id ? first : second;
  }
  uint64_t redraws() const override { return 0; }

 private:
  Selector& inner_;
};

class UniformSelectorTest : public testing::Test {
 protected:
  // At least that many; the newest one is sampleable, so that a draw that leaves it out is seen.
  void Store(uint64_t records) {
    RecordScript script(spec_, 0, 1, 2, /*mean_length=*/4);
    for (uint64_t sequence = 1;
         sequence <= records || (records > 1 && !index_.Sampleable(ring_.last_id())); ++sequence) {
      const RecordHeader& header = RecordLayout::Header(script.At(sequence).data());
      index_.Added(
          ring_.Append(0, 1, *index_.Predecessor(0, 1, header), script.At(sequence).data()));
    }
  }

  // Describes a deviation of the selector's draws from uniform ones: the count of one id, or of the
  // older half of the ids, differs by 5 sigma of a binomial. "" if there is no deviation.
  std::string Fault(Selector* selector) {
    constexpr int kDraws = 400'000;
    std::map<uint64_t, int> counts;
    Random random(42);
    for (int i = 0; i < kDraws; ++i) ++counts[selector->Draw(&random).value().id];
    const double n = static_cast<double>(index_.sampleable());
    const auto outside = [](int count, double p) {
      return std::abs(count - kDraws * p) > 5 * std::sqrt(kDraws * p * (1 - p));
    };
    int older = 0, seen = 0;
    uint64_t half = index_.sampleable() / 2;
    for (uint64_t id = ring_.oldest_id(); id <= ring_.last_id(); ++id) {
      if (!index_.Sampleable(id)) {
        if (counts.contains(id)) return "drew " + std::to_string(id) + ", not sampleable";
        continue;
      }
      if (outside(counts[id], 1 / n)) return "id " + std::to_string(id);
      if (static_cast<uint64_t>(seen++) < half) older += counts[id];
    }
    return outside(older, static_cast<double>(half) / n) ? "older half" : "";
  }

  const ObservationSpec spec_ = TinySpec(2);
  Ring ring_{spec_, {.file = {}, .capacity = 64, .run = ""}};
  EpisodeIndex index_{ring_, {.stack = 2}};
  UniformSelector selector_{ring_, index_};
};

TEST_F(UniformSelectorTest, DrawsEverySampleableStepEquallyOften) {
  Store(150);
  EXPECT_EQ(Fault(&selector_), "");
  EXPECT_GT(selector_.redraws(), 0u);
}

TEST_F(UniformSelectorTest, TheTestAboveTellsASlightlyBiasedSelector) {
  Store(150);
  BiasedSelector biased(&selector_);
  EXPECT_NE(Fault(&biased), "");
}

TEST_F(UniformSelectorTest, SaysTheProbability) {
  Store(150);
  Random random(1);
  const double n = static_cast<double>(index_.sampleable());
  EXPECT_DOUBLE_EQ(selector_.Draw(&random)->probability, 1 / n);
}

TEST_F(UniformSelectorTest, FindsNothingWhereNothingIs) {
  Random random(1);
  EXPECT_FALSE(selector_.Draw(&random).has_value());
  Store(1);
  EXPECT_FALSE(selector_.Draw(&random).has_value()) << "one reset";
}

TEST_F(UniformSelectorTest, TheSameStreamDrawsTheSameSteps) {
  Store(100);
  Random a(9), b(9);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(selector_.Draw(&a)->id, selector_.Draw(&b)->id);
}

}  // namespace
}  // namespace shoal::replay
