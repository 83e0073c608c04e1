// SPDX-License-Identifier: Apache-2.0
// Compares the kernels of losses with the operations of the CPU.
#include "learner/device/kernels/losses.h"

#include "learner/device/kernels/critic_loss.h"
#include "learner/engine/losses.h"
#include "tests/learner/device/kernels/kernel_fixture.h"

namespace shoal::learner::kernels {
namespace {

class LossKernels : public KernelTest {
 protected:
  double* Cell() { return Out<double>(1); }
  // The CPU sums in another order.
  static void ExpectNumber(const double* number, double expected) {
    EXPECT_NEAR(*number, expected, 2e-7 * (1e-3 + std::abs(expected)));
  }
};

TEST_F(LossKernels, Targets) {
  constexpr int kRows = 67;
  const std::vector<float> reward = Random(kRows), bootstrap = Random(kRows, 0, 1);
  const std::vector<float> q0 = Random(kRows), q1 = Random(kRows), q2 = Random(kRows);
  const std::vector<float> log_prob = Random(kRows, -4, 4);
  std::vector<float> expected(kRows);
  const std::vector<const float*> q{q0.data(), q1.data(), q2.data()};
  for (const bool entropy : {false, true}) {
    TdTargets(kRows, {reward.data(), bootstrap.data(), q, entropy ? log_prob.data() : nullptr},
              {2, 0.9f, 0.3f, {-0.4f, 0.1f}}, expected.data());
    float* y = Out(kRows);
    Run(kernels::Targets{.rows = kRows,
                         .critics = 3,
                         .reward = In(reward),
                         .bootstrap = In(bootstrap),
                         .next_q = {In(q0), In(q1), In(q2)},
                         .next_log_prob = entropy ? In(log_prob) : nullptr,
                         .temperature = In(std::vector<double>{0.3}),
                         .reward_scale = 2,
                         .discount = 0.9f,
                         .low = -0.4f,
                         .high = 0.1f,
                         .y = y});
    ExpectClose(y, expected, 1e-6);
  }
}

TEST_F(LossKernels, AveragesOfCopies) {
  std::vector<float> expected = Random(60);
  float* y = In(expected);
  learner::AverageCopies(60, 4, 3, expected.data());
  Run(kernels::AverageCopies{.rows = 60, .copies = 4, .averaged = 3, .y = y});
  ExpectClose(y, expected, 0);
}

TEST_F(LossKernels, CriticsOfOneOrMoreFunctions) {
  for (const int critics : {1, 2, 3}) {
    constexpr int kRows = 301;
    const std::vector<float> y = Random(kRows, 1, 3);
    kernels::CriticLoss loss{.rows = kRows, .critics = critics, .y = In(y)};
    std::vector<std::vector<float>> q;
    std::vector<const float*> all;
    all.reserve(size_t(critics));
    std::vector<float> least(kRows, INFINITY);
    for (int i = 0; i < critics; ++i) {
      q.push_back(Random(kRows, -2, 5));
      loss.q[i] = In(q.back());
      loss.q_gradient[i] = Out(kRows);
      for (size_t b = 0; b < kRows; ++b) least[b] = std::min(least[b], q.back()[b]);
    }
    for (const auto& values : q) all.push_back(values.data());
    loss.figures = {Cell(), Cell(), Cell(), Cell(), Cell(), Cell(),
                    Cell(), Cell(), Cell(), Cell(), Cell()};
    Run(loss);
    for (int i = 0; i < critics; ++i) {
      std::vector<float> gradient(kRows);
      CriticLossBackward(kRows, all[size_t(i)], y.data(), gradient.data());
      ExpectClose(loss.q_gradient[i], gradient, 1e-6);
    }
    const CriticFigures& to = loss.figures;
    const learner::CriticLoss expected = CriticLossForward(kRows, all, y.data());
    ExpectNumber(to.loss, expected.loss);
    ExpectNumber(to.q_mean, expected.q_mean);
    ExpectNumber(to.target_mean, expected.target_mean);
    ExpectNumber(to.q1_mean, Summarise(q[0]).mean);
    ExpectNumber(to.q1_std, Summarise(q[0]).deviation);
    if (critics > 1) {
      ExpectNumber(to.q2_mean, Summarise(q[1]).mean);
      ExpectNumber(to.q2_std, Summarise(q[1]).deviation);
    } else {
      EXPECT_TRUE(std::isnan(*to.q2_mean)) << "written without a second function";
    }
    ExpectNumber(to.q_min_mean, Summarise(least).mean);
    ExpectNumber(to.q_min_std, Summarise(least).deviation);
    ExpectNumber(to.q_min_min, Summarise(least).least);
    ExpectNumber(to.q_min_max, Summarise(least).most);
  }
}

TEST_F(LossKernels, TargetsOfChosenFunctions) {
  constexpr int kRows = 67;
  const std::vector<float> reward = Random(kRows), bootstrap = Random(kRows, 0, 1);
  const std::vector<float> q0 = Random(kRows), q1 = Random(kRows), q2 = Random(kRows);
  std::vector<float> expected(kRows);
  const std::vector<const float*> q{q2.data(), q0.data()};
  TdTargets(kRows, {reward.data(), bootstrap.data(), q}, {2, 0.9f, 0, {-0.4f, 0.1f}},
            expected.data());
  float* y = Out(kRows);
  Run(kernels::Targets{.rows = kRows,
                       .critics = 2,
                       .reward = In(reward),
                       .bootstrap = In(bootstrap),
                       .next_q = {In(q0), In(q1), In(q2)},
                       .chosen = In(std::vector<int32_t>{2, 0}),
                       .reward_scale = 2,
                       .discount = 0.9f,
                       .low = -0.4f,
                       .high = 0.1f,
                       .y = y});
  ExpectClose(y, expected, 1e-6);
}

TEST_F(LossKernels, CriticsOfWeightedRowsAndOfHuber) {
  constexpr int kRows = 301;
  const std::vector<float> y = Random(kRows, 1, 3), weights = Random(kRows, 0.01, 1);
  const std::vector<std::vector<float>> q{Random(kRows, -2, 5), Random(kRows, -2, 5)};
  const float* const all[] = {q[0].data(), q[1].data()};
  std::vector<float> errors(kRows);
  CriticErrors(kRows, all, y.data(), errors.data());
  for (const bool weighted : {false, true}) {
    for (const bool huber : {false, true}) {
      kernels::CriticLoss loss{.rows = kRows,
                               .critics = 2,
                               .q = {In(q[0]), In(q[1])},
                               .y = In(y),
                               .weights = weighted ? In(weights) : nullptr,
                               .huber = huber,
                               .q_gradient = {Out(kRows), Out(kRows)},
                               .errors = Out(kRows)};
      loss.figures.loss = Cell();
      Run(loss);
      const RowLoss rows{weighted ? weights.data() : nullptr, huber};
      ExpectNumber(loss.figures.loss, CriticLossForward(kRows, all, y.data(), rows).loss);
      for (size_t i = 0; i < 2; ++i) {
        std::vector<float> gradient(kRows);
        CriticLossBackward(kRows, all[i], y.data(), gradient.data(), rows);
        ExpectClose(loss.q_gradient[i], gradient, 1e-6);
      }
      ExpectClose(loss.errors, errors, 0);
    }
  }
}

TEST_F(LossKernels, ActorsWithEntropy) {
  constexpr int kRows = 300;
  const std::vector<float> log_prob = Random(kRows, -5, 5);
  for (const int critics : {2, 3, 5}) {
    for (const ActorValue value : {ActorValue::kMin, ActorValue::kMean}) {
      kernels::EntropyActorLoss kernel{.rows = kRows,
                                       .critics = critics,
                                       .of_mean = value == ActorValue::kMean,
                                       .log_prob = In(log_prob),
                                       .temperature = In(std::vector<double>{0.2}),
                                       .loss = Cell()};
      std::vector<std::vector<float>> q, gradients;
      for (int i = 0; i < critics; ++i) {
        q.push_back(Random(kRows));
        q[size_t(i)][7] = q[0][7];  // a tie
        gradients.emplace_back(kRows);
        kernel.q[i] = In(q.back());
        kernel.q_gradient[i] = Out(kRows);
      }
      std::vector<const float*> values;
      std::vector<float*> to;
      for (size_t i = 0; i < q.size(); ++i) {
        values.push_back(q[i].data());
        to.push_back(gradients[i].data());
      }
      const float loss = ActorLossForward(kRows, log_prob.data(), values, value, 0.2f);
      ActorLossBackward(kRows, values, value, to);
      Run(kernel);
      ExpectNumber(kernel.loss, loss);
      for (int i = 0; i < critics; ++i) ExpectClose(kernel.q_gradient[i], gradients[size_t(i)], 0);
    }
  }
}

TEST_F(LossKernels, ActorsWithoutEntropy) {
  constexpr int kRows = 131, kActions = 3;
  const std::vector<float> mean = Random(kRows * kActions, -2, 2);
  const std::vector<float> action = Random(kRows * kActions, -1.1, 1.1);
  std::vector<std::vector<float>> q{Random(kRows), Random(kRows), Random(kRows)};
  q[1][7] = q[0][7] = -2;  // a tie
  for (const int critics : {1, 2, 3}) {
    const double penalty = critics == 1 ? 0 : 0.7;
    kernels::DeterministicActorLoss kernel{.rows = kRows,
                                           .actions = kActions,
                                           .critics = critics,
                                           .mean = In(mean),
                                           .action = In(action),
                                           .mean_penalty = penalty,
                                           .loss = Cell(),
                                           .saturation = Cell()};
    std::vector<const float*> values;
    std::vector<std::vector<float>> gradients(q.size(), std::vector<float>(kRows));
    std::vector<float*> to;
    for (int i = 0; i < critics; ++i) {
      kernel.q[i] = In(q[size_t(i)]);
      kernel.q_gradient[i] = Out(kRows);
      values.push_back(q[size_t(i)].data());
      to.push_back(gradients[size_t(i)].data());
    }
    Run(kernel);
    ExpectNumber(kernel.loss, learner::DeterministicActorLoss(kRows, values, mean, penalty, to));
    ExpectNumber(kernel.saturation, SaturatedShare(action));
    for (int i = 0; i < critics; ++i) ExpectClose(kernel.q_gradient[i], gradients[size_t(i)], 0);
  }
}

TEST_F(LossKernels, LabelsAndMeans) {
  constexpr size_t kNumbers = 403;
  const std::vector<float> y = Random(kNumbers), labels = Random(kNumbers);
  std::vector<float> gradient(kNumbers);
  const double squares = learner::LabelLoss(y, labels, 0.6f, gradient);
  kernels::LabelLoss kernel{.n = kNumbers,
                            .y = In(y),
                            .labels = In(labels),
                            .weight = 0.6f,
                            .unit = 0.5f,
                            .gradient = {Out(kNumbers), Out<uint16_t>(kNumbers)},
                            .mean_square = Cell()};
  Run(kernel);
  ExpectClose(kernel.gradient.f32, gradient, 1e-6);
  ExpectClose(FromBf16s(kernel.gradient.bf16, kNumbers).data(), gradient, 0.005);
  ExpectNumber(kernel.mean_square, 0.25 * squares / kNumbers);
  double* mean = Cell();
  Run(kernels::Mean{.n = kNumbers, .values = kernel.y, .mean = mean});
  ExpectNumber(mean, Summarise(y).mean);
}

}  // namespace
}  // namespace shoal::learner::kernels
