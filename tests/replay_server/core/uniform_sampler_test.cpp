#include "replay_server/core/uniform_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "tests/replay_server/record_script.h"

namespace shoal::replay {
namespace {

// Draws every second time the lower of two ids: what a subtly wrong sampler looks like.
class BiasedSampler : public Sampler {
 public:
  explicit BiasedSampler(Sampler* inner) : inner_(*inner) {}
  std::optional<uint64_t> Draw(Random* random) override {
    const auto first = inner_.Draw(random);
    return random->Below(20) == 0 ? std::min(first, inner_.Draw(random)) : first;
  }
  uint64_t redraws() const override { return 0; }

 private:
  Sampler& inner_;
};

class UniformSamplerTest : public testing::Test {
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

  // What is not uniform about the sampler's draws: too few or too many of one id by 5 sigma of a
  // binomial, or of the older half of the ids; "" when nothing is.
  std::string Fault(Sampler* sampler) {
    constexpr int kDraws = 400'000;
    std::map<uint64_t, int> counts;
    Random random(42);
    for (int i = 0; i < kDraws; ++i) ++counts[sampler->Draw(&random).value()];
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
  EpisodeIndex index_{ring_, 2};
  UniformSampler sampler_{ring_, index_};
};

TEST_F(UniformSamplerTest, DrawsEverySampleableStepEquallyOften) {
  Store(150);
  EXPECT_EQ(Fault(&sampler_), "");
  EXPECT_GT(sampler_.redraws(), 0u);
}

TEST_F(UniformSamplerTest, TheTestAboveTellsASlightlyBiasedSampler) {
  Store(150);
  BiasedSampler biased(&sampler_);
  EXPECT_NE(Fault(&biased), "");
}

TEST_F(UniformSamplerTest, FindsNothingWhereNothingIs) {
  Random random(1);
  EXPECT_FALSE(sampler_.Draw(&random).has_value());
  Store(1);
  EXPECT_FALSE(sampler_.Draw(&random).has_value()) << "one reset";
}

TEST_F(UniformSamplerTest, TheSameStreamDrawsTheSameSteps) {
  Store(100);
  Random a(9), b(9);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(sampler_.Draw(&a), sampler_.Draw(&b));
}

}  // namespace
}  // namespace shoal::replay
