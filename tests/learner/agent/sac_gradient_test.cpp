// SPDX-License-Identifier: Apache-2.0
// Compares one whole update, with several ensembles of critics, with a reference in double
// precision: losses, and every gradient by central differences. The reference finds the drawn
// target critics by trying all subsets.
//
// The gradients are computed from Adam's first moment, which was 0 before: m = (1 - 0.9) g. Targets
// and temperature differ from those of a fresh agent, so that an exchange is detected.
#include <bit>
#include <map>
#include <numbers>
#include <numeric>

#include "tests/common/nn/reference_network.h"
#include "tests/learner/agent/adam_moments.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

using nn::ToDoubles;
using nn::reference::Network;
using nn::reference::Values;

struct Sample {
  Values action, log_prob;
};

// Critics: the keys of section sac.
struct Ensemble {
  std::string name;
  int critics = 2, target_critics = 0;
  std::string actor_value = "min";
  int quantiles = 0, dropped_quantiles = 2;
};

void PrintTo(const Ensemble& each, std::ostream* out) { *out << each.name; }

Config EnsembleConfig(const Ensemble& ensemble) {
  Config config = SmallConfig();
  config.sac.critics = ensemble.critics;
  config.sac.target_critics = ensemble.target_critics;
  config.sac.actor_value = ensemble.actor_value;
  config.sac.quantiles = ensemble.quantiles;
  config.sac.dropped_quantiles = ensemble.dropped_quantiles;
  config.learner.target_period = 1'000;  // so that the target critics keep their differences
  return config;
}

// Numbers of critics, which begin with 1.
using Subset = std::vector<int>;

// All subsets of `count` of the numbers 1 ... n.
std::vector<Subset> SubsetsOf(int n, int count) {
  std::vector<Subset> subsets;
  for (unsigned bits = 0; bits < 1u << n; ++bits) {
    if (std::popcount(bits) != count) continue;
    Subset subset;
    for (int i = 0; i < n; ++i) {
      if ((bits >> i & 1u) != 0) subset.push_back(i + 1);
    }
    subsets.push_back(subset);
  }
  return subsets;
}

class SacGradientTest : public testing::TestWithParam<Ensemble> {
 protected:
  SacGradientTest()
      : agent_(MakeAgent(config_, spec_, nn::Precision::kF32)), data_(spec_, batch_size_, 3) {}

  // tanh-Gaussian actions with the noise the agent draws: (B, A) per call.
  Sample Draw(const Network::Gaussian& gaussian, const Values& noise) const {
    Sample sample{{}, Values(size_t(batch_size_))};
    const size_t actions = size_t(spec_.action_size);
    for (size_t i = 0; i < noise.size(); ++i) {
      const double u = gaussian.mean[i] + std::exp(gaussian.log_std[i]) * noise[i];
      sample.action.push_back(std::tanh(u));
      sample.log_prob[i / actions] += -0.5 * noise[i] * noise[i] - gaussian.log_std[i] -
                                      0.5 * std::log(2 * std::numbers::pi) -
                                      std::log(1 - std::tanh(u) * std::tanh(u));
    }
    return sample;
  }

  Values Noise(Random* random) const {
    Values noise(size_t(batch_size_ * spec_.action_size));
    for (double& value : noise) value = float(random->Normal());
    return noise;
  }

  // `critics`: the target critics whose minimum is used.
  Values Targets(const Network& network, const Subset& critics, const Values& noise) const {
    const BatchView view = data_.View();
    const Values features = network.Features(batch_size_, view.next_obs_frames.data());
    const Values vector = ToDoubles(view.next_obs_vector);
    const Sample next = Draw(network.Actor(batch_size_, features, vector), noise);
    const size_t rows = size_t(batch_size_);
    std::vector<Values> next_values(rows);  // of all critics, for each row
    for (const int i : critics) {
      const Values q = network.Q("target", i, batch_size_, features, vector, next.action);
      const size_t columns = q.size() / rows;
      for (size_t k = 0; k < q.size(); ++k) next_values[k / columns].push_back(q[k]);
    }
    Values y;
    for (size_t b = 0; b < rows; ++b) {
      std::ranges::sort(next_values[b]);
      next_values[b].resize(TargetsOfARow());
      for (const double next_value : next_values[b]) {
        const double value = next_value - temperature_ * next.log_prob[b];
        y.push_back(config_.learner.reward_scale * view.reward[b] +
                    view.bootstrap[b] * config_.learner.discount * value);
      }
    }
    return y;
  }

  // The smallest value, or the quantiles without the largest ones.
  size_t TargetsOfARow() const {
    const SacConfig& sac = config_.sac;
    return sac.quantiles == 0 ? 1 : size_t(sac.critics * (sac.quantiles - sac.dropped_quantiles));
  }

  // The subsets of target critics that lead to this mean target. Several subsets lead to the same
  // targets if the critics in which they differ are nowhere the smallest.
  std::vector<Subset> SubsetsThatGive(double target_mean, const Network& network,
                                      const Values& noise) const {
    const int all = config_.sac.critics, drawn = config_.sac.target_critics;
    std::vector<Subset> fitting;
    for (const Subset& subset : SubsetsOf(all, drawn == 0 ? all : drawn)) {
      const Values y = Targets(network, subset, noise);
      const double mean = std::accumulate(y.begin(), y.end(), 0.0) / double(y.size());
      if (std::abs(mean - target_mean) < 1e-5) fitting.push_back(subset);
    }
    return fitting;
  }

  double CriticLoss(const Network& network, const Values& y) const {
    const BatchView view = data_.View();
    const Values features = network.Features(batch_size_, view.obs_frames.data());
    double loss = 0;
    for (int i = 1; i <= config_.sac.critics; ++i) {
      const Values q = network.Q("critic", i, batch_size_, features, ToDoubles(view.obs_vector),
                                 ToDoubles(view.action));
      loss += config_.sac.quantiles == 0 ? SumOfSquares(q, y) : SumOfQuantileLosses(q, y);
    }
    return loss / batch_size_;
  }

  static double SumOfSquares(const Values& q, const Values& y) {
    double sum = 0;
    for (size_t b = 0; b < y.size(); ++b) sum += (q[b] - y[b]) * (q[b] - y[b]);
    return sum;
  }

  double SumOfQuantileLosses(const Values& q, const Values& y) const {
    const size_t count = size_t(config_.sac.quantiles), targets = TargetsOfARow();
    double sum = 0;
    for (size_t k = 0; k < q.size(); ++k) {
      const double tau = (double(k % count) + 0.5) / double(count);
      for (size_t j = 0; j < targets; ++j) {
        const double error = y[k / count * targets + j] - q[k];
        const double size = std::abs(error);
        const double huber = size <= 1 ? error * error / 2 : size - 0.5;
        sum += (error < 0 ? 1 - tau : tau) * huber / double(count * targets);
      }
    }
    return sum;
  }

  // The actor of `network` judged by the critics of `critic`, on given features.
  double ActorLoss(const Network& network, const Network& critic, const Values& features,
                   const Values& noise) const {
    const Values vector = ToDoubles(data_.View().obs_vector);
    const Sample sample = Draw(network.Actor(batch_size_, features, vector), noise);
    const bool mean = config_.sac.actor_value == "mean";
    Values value(sample.log_prob.size(), mean ? 0 : INFINITY);
    for (int i = 1; i <= config_.sac.critics; ++i) {
      const Values q = critic.Q("critic", i, batch_size_, features, vector, sample.action);
      const size_t columns = q.size() / value.size();  // quantiles count by their mean
      for (size_t b = 0; b < value.size(); ++b) {
        const auto row = q.begin() + ptrdiff_t(b * columns);
        const double own = std::accumulate(row, row + ptrdiff_t(columns), 0.0) / double(columns);
        value[b] = mean ? value[b] + own / config_.sac.critics : std::min(value[b], own);
      }
    }
    double loss = 0;
    for (size_t b = 0; b < value.size(); ++b) {
      loss += temperature_ * sample.log_prob[b] - value[b];
    }
    return loss / batch_size_;
  }

  // Makes targets and temperature differ from those of a fresh agent.
  void MakeLater() {
    nn::TensorMap later = Perturbed(agent_->AllTensors(), "target.");
    const auto log_temperature = float(std::log(temperature_));
    std::memcpy(later.at("temperature.log").data.data(), &log_temperature, sizeof(float));
    agent_->Restore(later, "later");
  }

  // The stream of the agent's next update.
  Random Stream() const {
    return Random(StreamKey(uint64_t(config_.seed), StreamRole::kLearnerUpdate, agent_->updates()));
  }

  const ObservationSpec spec_ = SmallSpec();
  const Config config_ = EnsembleConfig(GetParam());
  const int batch_size_ = config_.learner.batch;
  double temperature_ = 0.37;
  const std::unique_ptr<Agent> agent_;
  RandomBatch data_;
};

TEST_P(SacGradientTest, ALaterUpdateFollowsTheEquations) {
  MakeLater();
  const nn::TensorMap before = agent_->AllTensors();
  Random random = Stream();
  const UpdateOutcome stats = agent_->Update(data_.View());
  const nn::TensorMap after = agent_->AllTensors();
  Network network(before, config_.network, spec_);
  const Network updated(after, config_.network, spec_);
  const Values next_noise = Noise(&random);
  // A draw takes a number of the stream for each critic that is drawn.
  for (int i = 0; i < config_.sac.target_critics; ++i) random.Next();
  const Values noise = Noise(&random);

  const auto subsets = SubsetsThatGive(Get(stats, kTargetMean), network, next_noise);
  ASSERT_FALSE(subsets.empty());
  const Values y = Targets(network, subsets[0], next_noise);
  const auto critic_loss = [&] { return CriticLoss(network, y); };
  EXPECT_NEAR(Get(stats, kCriticLoss), critic_loss(), 1e-4 * critic_loss());
  ExpectMoments(after, "encoder.", &network, critic_loss);
  ExpectMoments(after, "critic.", &network, critic_loss);

  // The actor sees the features of before and the critic of after its step.
  const Values features = network.Features(batch_size_, data_.View().obs_frames.data());
  const auto actor_loss = [&] { return ActorLoss(network, updated, features, noise); };
  EXPECT_NEAR(Get(stats, kActorLoss), actor_loss(), 1e-4 * std::abs(actor_loss()));
  ExpectMoments(after, "actor.", &network, actor_loss);

  const Sample sample =
      Draw(network.Actor(batch_size_, features, ToDoubles(data_.View().obs_vector)), noise);
  double entropy = 0;
  for (const double log_prob : sample.log_prob) entropy -= log_prob / batch_size_;
  EXPECT_NEAR(Get(stats, kEntropy), entropy, 1e-4);
  const double temperature_loss = temperature_ * (entropy + spec_.action_size);
  EXPECT_NEAR(Floats(after, "adam.m.temperature.log")[0], kFirstMoment * temperature_loss, 1e-5);
}

const Ensemble kEnsembles[] = {
    {.name = "twins"},
    {.name = "smallest_of_three", .critics = 3},
    {.name = "twins_by_their_mean", .actor_value = "mean"},
    {.name = "redq", .critics = 5, .target_critics = 2, .actor_value = "mean"},
    {.name = "one_target_of_three", .critics = 3, .target_critics = 1},
    {.name = "quantiles", .actor_value = "mean", .quantiles = 5, .dropped_quantiles = 1},
    {.name = "quantiles_of_three", .critics = 3, .quantiles = 4, .dropped_quantiles = 0},
};

INSTANTIATE_TEST_SUITE_P(Of, SacGradientTest, testing::ValuesIn(kEnsembles),
                         [](const auto& each) { return each.param.name; });

// One target critic of five, so that the target tells which one was drawn.
class SacDrawTest : public SacGradientTest {};

TEST_P(SacDrawTest, EachUpdateDrawsATargetCriticForTheWholeBatch) {
  constexpr int kDraws = 400;
  MakeLater();
  std::map<int, int> drawn;
  for (int u = 0; u < kDraws; ++u) {
    const nn::TensorMap before = agent_->AllTensors();
    const Network network(before, config_.network, spec_);
    temperature_ = std::exp(Floats(before, "temperature.log")[0]);
    Random random = Stream();
    const UpdateOutcome outcome = agent_->Update(data_.View());
    const auto fitting = SubsetsThatGive(Get(outcome, kTargetMean), network, Noise(&random));
    ASSERT_EQ(fitting.size(), 1u) << u;
    ++drawn[fitting[0][0]];
  }
  const double share = 1.0 / config_.sac.critics;
  const double tolerance = 5 * std::sqrt(kDraws * share * (1 - share));
  for (int i = 1; i <= config_.sac.critics; ++i) {
    EXPECT_NEAR(drawn[i], kDraws * share, tolerance) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, SacDrawTest,
                         testing::Values(Ensemble{
                             .name = "one_of_five", .critics = 5, .target_critics = 1}),
                         [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace shoal::learner
