// SPDX-License-Identifier: Apache-2.0
// The critic's loss with priorities (Eq. 34), compared with a reference in double precision: the
// loss, its gradients by central differences, and the errors of rows.
//
// All transitions terminate, so that a target is the scaled reward. Other tests compare targets.
#include <cmath>

#include "learner/agent/critic_rows.h"
#include "tests/common/nn/reference_network.h"
#include "tests/learner/agent/adam_moments.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

using nn::ToDoubles;
using nn::reference::Network;
using nn::reference::Values;

struct PrioritisedCase {
  std::string algorithm;
  std::vector<std::string> critics;  // MLPs of a critic
  std::string priorities;
};

void PrintTo(const PrioritisedCase& each, std::ostream* out) {
  *out << each.algorithm << "_" << each.priorities;
}

Config PrioritisedConfig(const PrioritisedCase& each) {
  Config config = SmallConfig();
  config.learner.algorithm = each.algorithm;
  config.replay.priorities = each.priorities;
  if (each.priorities == "proportional") config.replay.priority_correction = {0.2, 0.8, 1000};
  return config;
}

class PrioritisedAgentTest : public testing::TestWithParam<PrioritisedCase> {
 protected:
  PrioritisedAgentTest() {
    for (float& bootstrap : data_.View().bootstrap) bootstrap = 0;
  }

  // Q (B) of each critic.
  std::vector<Values> Critics(const Network& network) const {
    const BatchView view = data_.View();
    const Values features = network.Features(batch_size_, view.obs_frames.data());
    const Values observation =
        network.Observation("critic", batch_size_, features, ToDoubles(view.obs_vector));
    const size_t columns = observation.size() / view.rows();
    const auto actions = size_t(spec_.action_size);
    Values input;
    for (size_t b = 0; b < view.rows(); ++b) {
      input.insert(input.end(), observation.begin() + long(b * columns),
                   observation.begin() + long((b + 1) * columns));
      const auto action = view.action.subspan(b * actions, actions);
      input.insert(input.end(), action.begin(), action.end());
    }
    std::vector<Values> q;
    for (const std::string& mlp : GetParam().critics) {
      q.push_back(network.Mlp("critic." + mlp, batch_size_, input));
    }
    return q;
  }

  double Target(size_t row) const {
    return config_.learner.reward_scale * data_.View().reward[row];
  }

  // (N P)^-b, divided by the largest weight of the batch, at 500 of the 1000 steps of the schedule.
  double Weight(size_t row) const {
    if (GetParam().priorities == "lap") return 1;
    const auto probability = data_.View().probability;
    double largest = 0;
    for (const float p : probability) largest = std::max(largest, std::pow(1000 * p, -0.5));
    return std::pow(1000 * probability[row], -0.5) / largest;
  }

  double CriticLoss(const Network& network) const {
    double loss = 0;
    for (const Values& q : Critics(network)) {
      for (size_t b = 0; b < q.size(); ++b) {
        const double error = std::abs(q[b] - Target(b));
        const bool far = GetParam().priorities == "lap" && error > 1;
        loss += Weight(b) * (far ? 2 * error - 1 : error * error);
      }
    }
    return loss / batch_size_;
  }

  const ObservationSpec spec_ = SmallSpec();
  const Config config_ = PrioritisedConfig(GetParam());
  const int batch_size_ = config_.learner.batch;
  const std::unique_ptr<Agent> agent_ = MakeAgent(config_, spec_, nn::Precision::kF32);
  RandomBatch data_{spec_, BatchOptions{.batch = batch_size_, .probabilities = true}, 3};
};

TEST_P(PrioritisedAgentTest, ACriticsLossFollowsTheEquation) {
  const nn::TensorMap before = agent_->AllTensors();
  BatchView view = data_.View();
  view.stored_steps = 500;
  const UpdateOutcome outcome = agent_->Update(view);
  const nn::TensorMap after = agent_->AllTensors();
  Network network(before, config_.network, spec_);
  const auto loss = [&] { return CriticLoss(network); };
  EXPECT_NEAR(Get(outcome, kCriticLoss), loss(), 1e-4 * loss());
  ExpectMoments(after, "encoder.", &network, loss);
  ExpectMoments(after, "critic.", &network, loss);

  const std::vector<Values> q = Critics(network);
  ASSERT_EQ(outcome.errors.size(), view.rows());
  size_t far = 0;
  double weights = 0;
  for (size_t b = 0; b < view.rows(); ++b) {
    double error = 0;
    for (const Values& values : q) error = std::max(error, std::abs(values[b] - Target(b)));
    EXPECT_NEAR(outcome.errors[b], error, 1e-4) << b;
    far += error > 1;
    weights += Weight(b) / batch_size_;
  }
  EXPECT_TRUE(far > 0 && far < view.rows()) << "errors on both sides of 1";
  if (GetParam().priorities == "lap") {
    EXPECT_FALSE(outcome.figures.Get(kImportanceWeight));
  } else {
    EXPECT_NEAR(Get(outcome, kImportanceWeight), weights, 1e-5);
    EXPECT_LT(weights, 0.9);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, PrioritisedAgentTest,
                         testing::Values(PrioritisedCase{"sac", {"q1", "q2"}, "proportional"},
                                         PrioritisedCase{"sac", {"q1", "q2"}, "lap"},
                                         PrioritisedCase{"td3", {"q1", "q2"}, "proportional"},
                                         PrioritisedCase{"ddpg", {"q1"}, "lap"}),
                         [](const auto& test) {
                           return test.param.algorithm + "_" + test.param.priorities;
                         });

TEST(Agents, WithoutPrioritiesReturnNoErrors) {
  const Config config = SmallConfig();
  const auto agent = MakeAgent(config, SmallSpec(), nn::Precision::kF32);
  const RandomBatch batch(SmallSpec(), config.learner.batch, 3);
  EXPECT_TRUE(agent->Update(batch.View()).errors.empty());
}

}  // namespace
}  // namespace shoal::learner
