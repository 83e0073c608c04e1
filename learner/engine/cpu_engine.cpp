// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/cpu_engine.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/check.h"
#include "common/nn/host_memory.h"
#include "common/nn/vector_scale.h"
#include "learner/engine/batch_faults.h"
#include "learner/engine/batch_part.h"
#include "learner/engine/clipped_policy_loss.h"
#include "learner/engine/draw_subset.h"
#include "learner/engine/moments.h"

namespace shoal::learner {
namespace {

using nn::HostArray;
using nn::HostValues;

double& Cell(Number number) { return HostValues(number).front(); }

// Null if the array is absent.
float* Data(Array array) { return HostValues(array).data(); }

std::vector<float*> ResultsOf(std::span<const Array> arrays) {
  std::vector<float*> data;
  for (const Array array : arrays) data.push_back(Data(array));
  return data;
}

std::vector<const float*> DataOf(std::span<const Array> arrays) {
  std::vector<const float*> data;
  for (const Array array : arrays) data.push_back(Data(array));
  return data;
}

SquashedValues ValuesOf(const SquashedSample& sample) {
  return {HostValues(sample.scaled_noise), HostValues(sample.action), HostValues(sample.log_prob)};
}

}  // namespace

CpuEngine::CpuEngine(nn::Precision precision, int batch, nn::Replica* replica)
    : batch_(batch), replica_(replica), modules_(precision, batch, replica) {}

Array CpuEngine::NewArray(int columns) {
  return HostArray(arrays_.emplace_back(Rows() * size_t(columns), 0.f));
}

Number CpuEngine::NewNumber() { return HostArray(std::span(&numbers_.emplace_back(0), 1)); }

Moments CpuEngine::NewMoments(int width) {
  return HostArray(moments_.emplace_back(MomentsSize(size_t(width)), 0.0));
}

void CpuEngine::Set(Number number, double value) {
  CHECK(!updating_);
  Cell(number) = value;
}

void CpuEngine::Put(std::span<const float> values, Array array) {
  CHECK(!updating_ && values.size() % size_t(batch_) == 0) << values.size();
  const nn::Replica::Rows rows = replica_->RowsOf(batch_);
  const size_t columns = values.size() / size_t(batch_);
  std::ranges::copy(values.subspan(size_t(rows.begin) * columns, size_t(rows.count) * columns),
                    HostValues(array).begin());
}

void CpuEngine::Begin(const BatchView& drawn) {
  CHECK(!updating_ && int(drawn.rows()) == batch_) << "batch of " << drawn.rows();
  updating_ = true;
  outcome_ = {};
  outcome_.finite = outcome_.batch_finite = AllFinite(drawn);
  overflows_ = false;
  taken_.clear();
  means_.clear();
  critic_arrays_.clear();
  errors_.clear();
}

Array CpuEngine::TakeRows(std::span<float> values) {
  CHECK(updating_ && values.size() == size_t(batch_)) << values.size();
  const nn::Replica::Rows rows = replica_->RowsOf(batch_);
  return HostArray(values.subspan(size_t(rows.begin), size_t(rows.count)));
}

Transitions CpuEngine::Take(const BatchView& batch) {
  const BatchView own = PartOf(batch, replica_->RowsOf(batch_));
  std::vector<Transitions::Step> steps;
  for (const StepView& step : own.steps) {
    steps.push_back({.next_frames = HostArray(step.next_frames),
                     .next_vector = HostArray(step.next_vector),
                     .action = HostArray(step.action),
                     .reward = HostArray(step.reward),
                     .terminated = HostArray(step.terminated),
                     .present = HostArray(step.present)});
  }
  return {.obs_frames = HostArray(own.obs_frames),
          .next_obs_frames = HostArray(own.next_obs_frames),
          .obs_vector = HostArray(own.obs_vector),
          .next_obs_vector = HostArray(own.next_obs_vector),
          .obs_privileged = HostArray(own.obs_privileged),
          .next_obs_privileged = HostArray(own.next_obs_privileged),
          .action = HostArray(own.action),
          .reward = HostArray(own.reward),
          .bootstrap = HostArray(own.bootstrap),
          .drawn_action = HostArray(own.drawn_action),
          .log_prob = HostArray(own.log_prob),
          .steps = std::move(steps)};
}

std::optional<Engine::Outcome> CpuEngine::End() {
  CHECK(updating_);
  updating_ = false;
  if (outcome_.finite) return outcome_;
  // An update with a number that is not finite leaves no trace: its steps are undone in reverse
  // order.
  std::for_each(taken_.rbegin(), taken_.rend(), [](const Taken& step) {
    step.optimiser->Undo();
    for (nn::Module* module : step.changed) module->Refresh();
  });
  return outcome_;
}

Engine::Outcome CpuEngine::WaitOutcome() {
  CHECK(false) << "no update is in flight";
  return outcome_;
}

double CpuEngine::Read(Number number) const {
  CHECK(!updating_) << "an update depends on no number that is read";
  return Cell(number);
}

std::vector<float> CpuEngine::ReadRows(Array array) const {
  CHECK(!updating_) << "an update depends on no array that is read";
  const std::span<const float> values = HostValues(array);
  return {values.begin(), values.end()};
}

std::function<std::vector<double>()> CpuEngine::CopyMoments(Moments moments) const {
  CHECK(!updating_);
  const std::span<const double> values = HostValues(moments);
  return [copy = std::vector<double>(values.begin(), values.end())] { return copy; };
}

void CpuEngine::SetMoments(Moments moments, std::span<const double> values) {
  CHECK(!updating_ && int64_t(values.size()) == moments.size()) << values.size();
  std::ranges::copy(values, HostValues(moments).begin());
}

void CpuEngine::JoinColumns(Array left, Array right, std::span<const ObservationSpec::Range> ranges,
                            Array joined) {
  learner::JoinColumns(Rows(), HostValues(left), HostValues(right), ranges, HostValues(joined));
}

void CpuEngine::SplitColumns(Array joined, Array left, Array right) {
  learner::SplitColumns(Rows(), HostValues(joined), HostValues(left), HostValues(right));
}

void CpuEngine::GatherLabels(Array observed, Array privileged,
                             std::span<const LabelColumns> columns, float unit, Array labels) {
  learner::GatherLabels(Rows(), HostValues(observed), HostValues(privileged), columns, unit,
                        HostValues(labels));
}

void CpuEngine::Standardise(Array x, Moments moments, float variance_floor, Array y) {
  const std::span<const double> values = HostValues(moments);
  const nn::VectorScale scale(MeanOf(values), VarianceOf(values, variance_floor));
  scale.Apply(Data(x), HostValues(y));
}

void CpuEngine::AddToMoments(std::span<const float> vectors, Moments moments) {
  // An update that will be undone must not move the moments either.
  if (!updating_ || Moves()) learner::AddToMoments(vectors, HostValues(moments));
}

void CpuEngine::SampleSquashedGaussian(Array mean, Array log_std, Random* random,
                                       const SquashedSample& sample) {
  const int actions = int(mean.size() / modules_.batch);
  const std::vector<double> normals = replica_->Normals(batch_, actions, random);
  noise_.assign(normals.begin(), normals.end());
  SquashGaussian(HostValues(mean), HostValues(log_std), noise_, ValuesOf(sample));
}

void CpuEngine::SquashedGaussianBackward(const SquashedSample& sample, Array action_gradient,
                                         Number temperature, Array mean_gradient,
                                         Array log_std_gradient) {
  learner::SquashedGaussianBackward(ValuesOf(sample), HostValues(action_gradient),
                                    float(Cell(temperature)) / float(Rows()),
                                    HostValues(mean_gradient), HostValues(log_std_gradient));
}

void CpuEngine::SquashedGaussianFigures(const SquashedSample& sample, Number entropy,
                                        Number saturation) {
  AddMean(SquashedEntropy(HostValues(sample.log_prob)), entropy, /*rounds=*/true);
  AddMean(float(SaturatedShare(HostValues(sample.action))), saturation, /*rounds=*/false);
}

void CpuEngine::AddClippedNoise(Array action, Number sigma, double limit, Random* random,
                                Array noisy) {
  const std::span<const float> own = HostValues(action);
  const std::span<float> result = HostValues(noisy);
  const std::vector<double> normals = replica_->Normals(batch_, int(own.size() / Rows()), random);
  const double deviation = Cell(sigma);
  for (size_t i = 0; i < normals.size(); ++i) {
    const double noise = std::clamp(deviation * normals[i], -limit, limit);
    result[i] = float(std::clamp(own[i] + noise, -1.0, 1.0));
  }
}

void CpuEngine::Targets(const TargetTerms& terms, Array y) {
  TargetRates rates{.reward_scale = terms.reward_scale,
                    .discount = terms.discount,
                    .temperature = 0,
                    .bounds = terms.bounds};
  if (terms.next_log_prob) rates.temperature = float(Cell(terms.temperature));
  std::vector<const float*> q = DataOf(terms.next_q);
  if (terms.drawn > 0) {
    std::vector<const float*> drawn;
    for (const int32_t i : DrawSubset(int(q.size()), terms.drawn, terms.random)) {
      drawn.push_back(q[size_t(i)]);
    }
    q = std::move(drawn);
  }
  TdTargets(modules_.batch,
            {Data(terms.reward), Data(terms.bootstrap), q, Data(terms.next_log_prob)}, rates,
            Data(y));
}

void CpuEngine::AverageCopies(int copies, int shifts, Array y) {
  learner::AverageCopies(modules_.batch, copies, shifts, Data(y));
}

void CpuEngine::CriticLoss(std::span<const Array> q, Array y, const CriticRows& rows,
                           std::span<const Array> q_gradients, const CriticNumbers& figures) {
  CHECK(critic_arrays_.empty() && q.size() == q_gradients.size()) << q.size();
  for (size_t i = 0; i < q.size(); ++i) {
    CriticLossBackward(modules_.batch, Data(q[i]), Data(y), Data(q_gradients[i]),
                       {Data(rows.weights), rows.huber});
    critic_arrays_.push_back(HostValues(q[i]));
  }
  critic_arrays_.push_back(HostValues(y));
  if (rows.weights) critic_arrays_.push_back(HostValues(rows.weights));
  critic_rows_ = rows;
  critic_figures_ = figures;
}

void CpuEngine::FinishCriticLoss(const std::vector<std::vector<float>>& whole) {
  const size_t critics = whole.size() - (critic_rows_.weights ? 2 : 1);
  const std::vector<float>& y = whole[critics];
  std::vector<const float*> q;
  for (size_t i = 0; i < critics; ++i) q.push_back(whole[i].data());
  const CriticNumbers& to = critic_figures_;
  const learner::CriticLoss loss =
      CriticLossForward(int(y.size()), q, y.data(),
                        {critic_rows_.weights ? whole.back().data() : nullptr, critic_rows_.huber});
  if (critic_rows_.returns_errors) {
    errors_.resize(y.size());
    CriticErrors(int(y.size()), q, y.data(), errors_.data());
  }
  Cell(to.loss) = loss.loss;
  Cell(to.q_mean) = loss.q_mean;
  Cell(to.target_mean) = loss.target_mean;
  const Summary first = Summarise(whole[0]);
  Cell(to.q1_mean) = first.mean;
  Cell(to.q1_std) = first.deviation;
  std::vector<float> smallest = whole[0];
  if (q.size() > 1) {
    const Summary second = Summarise(whole[1]);
    Cell(to.q2_mean) = second.mean;
    Cell(to.q2_std) = second.deviation;
  }
  for (size_t i = 1; i < q.size(); ++i) {
    for (size_t b = 0; b < smallest.size(); ++b) smallest[b] = std::min(smallest[b], q[i][b]);
  }
  const Summary least = Summarise(smallest);
  Cell(to.q_min_mean) = least.mean;
  Cell(to.q_min_std) = least.deviation;
  Cell(to.q_min_min) = least.least;
  Cell(to.q_min_max) = least.most;
}

void CpuEngine::EntropyActorLoss(Array log_prob, std::span<const Array> q, ActorValue value,
                                 Number temperature, std::span<const Array> q_gradients,
                                 Number loss) {
  CHECK(q.size() == q_gradients.size()) << q.size();
  const std::vector<const float*> values = DataOf(q);
  AddMean(ActorLossForward(modules_.batch, Data(log_prob), values, value, float(Cell(temperature))),
          loss, /*rounds=*/true);
  ActorLossBackward(modules_.batch, values, value, ResultsOf(q_gradients));
}

void CpuEngine::DeterministicActorLoss(std::span<const Array> q, Array mean, Array action,
                                       double mean_penalty, std::span<const Array> q_gradients,
                                       Number loss, Number saturation) {
  CHECK(!q.empty() && q.size() == q_gradients.size()) << q.size();
  AddMean(learner::DeterministicActorLoss(modules_.batch, DataOf(q), HostValues(mean), mean_penalty,
                                          ResultsOf(q_gradients)),
          loss, /*rounds=*/true);
  AddMean(SaturatedShare(HostValues(action)), saturation, /*rounds=*/false);
}

void CpuEngine::LabelLoss(Array y, Array labels, float weight, float unit, Array gradient,
                          Number mean_square) {
  const double squares =
      learner::LabelLoss(HostValues(y), HostValues(labels), weight, HostValues(gradient));
  AddMean(double(unit) * unit * squares / double(y.size()), mean_square, /*rounds=*/false);
}

void CpuEngine::ClippedPolicyLoss(const ClippedPolicyTerms& terms, nn::ParameterSet* log_std,
                                  Array mean_gradient, Array value_gradient,
                                  const ClippedPolicyNumbers& figures) {
  const size_t actions = HostValues(terms.mean).size() / Rows();
  const learner::ClippedPolicyLoss loss =
      ClippedPolicyLossAndGradients({.batch = modules_.batch,
                                     .action_size = int(actions),
                                     .mean = HostValues(terms.mean),
                                     .log_std = {log_std->values(), actions},
                                     .value = HostValues(terms.value),
                                     .drawn_action = HostValues(terms.drawn_action),
                                     .old_log_prob = HostValues(terms.old_log_prob),
                                     .old_value = HostValues(terms.old_value),
                                     .advantage = HostValues(terms.advantage),
                                     .target = HostValues(terms.target),
                                     .clip = Cell(terms.clip),
                                     .value_clip = terms.value_clip,
                                     .value_weight = terms.value_weight,
                                     .entropy_weight = terms.entropy_weight,
                                     .normalise_advantages = terms.normalise_advantages},
                                    {.mean = HostValues(mean_gradient),
                                     .log_std = {log_std->gradients(), actions},
                                     .value = HostValues(value_gradient)});
  AddMean(loss.policy, figures.policy, /*rounds=*/false);
  AddMean(loss.value, figures.value, /*rounds=*/false);
  AddMean(loss.approx_kl, figures.approx_kl, /*rounds=*/false);
  AddMean(loss.clip_fraction, figures.clip_fraction, /*rounds=*/false);
  AddMean(loss.total, figures.total, /*rounds=*/false);
  AddMean(loss.total, figures.rounded_total, /*rounds=*/true);
}

void CpuEngine::GaussianFigures(const nn::ParameterSet& log_std, Number deviation, Number entropy) {
  const auto actions = size_t(log_std.specs()[0].shape[0]);
  const GaussianSpread spread = SpreadOf({log_std.values(), actions});
  Cell(deviation) = spread.deviation;
  Cell(entropy) = spread.entropy;
}

void CpuEngine::Mean(Array values, Number mean) {
  AddMean(Summarise(HostValues(values)).mean, mean, /*rounds=*/false);
}

void CpuEngine::OnHost(std::span<const Array> inputs, std::span<const Array> outputs,
                       const HostOperation& operation) {
  std::vector<std::span<const float>> in;
  for (const Array array : inputs) in.push_back(HostValues(array));
  std::vector<std::span<float>> out;
  for (const Array array : outputs) out.push_back(HostValues(array));
  operation(in, out);
}

void CpuEngine::Temperature(const nn::ParameterSet& log_temperature, Number temperature) {
  Cell(temperature) = std::exp(log_temperature.values()[0]);
}

void CpuEngine::TemperatureLoss(Number temperature, Number entropy, float target_entropy,
                                Number loss) {
  Cell(loss) =
      learner::TemperatureLoss(float(Cell(temperature)), float(Cell(entropy)), target_entropy);
}

void CpuEngine::StepTemperature(Number loss, double least, nn::ParameterSet* log_temperature,
                                nn::Adam* optimiser) {
  if (!Moves()) return;
  log_temperature->gradients()[0] = float(Cell(loss));
  optimiser->Step();
  taken_.push_back({optimiser, {}});
  float& value = log_temperature->values()[0];
  value = std::max(value, float(std::log(least)));  // log(0) is -inf: no bound
}

void CpuEngine::AddMean(double own, Number number, bool rounds) {
  Cell(number) = own;
  means_.push_back({number, rounds});
}

void CpuEngine::RequireFinite(Number number) {
  // A held update takes no step, so its numbers do not matter.
  if (outcome_.held) return;
  outcome_.finite = outcome_.finite && std::isfinite(Cell(number));
}

void CpuEngine::SetRateFactor(Number factor, nn::Adam* optimiser) {
  optimiser->set_rate_factor(Cell(factor));
}

void CpuEngine::Gather(nn::Adam* optimiser, Number gradient_squares) {
  std::vector<double> own;
  for (const OwnMean& mean : means_) own.push_back(Cell(mean.number));
  replica_->Post(critic_arrays_, std::move(own));
  const double squares = optimiser->GatherGradients();
  const nn::Replica::Whole whole = replica_->Posted();
  Cell(gradient_squares) = squares;
  for (size_t i = 0; i < means_.size(); ++i) {
    const double mean = whole.means[i];
    Cell(means_[i].number) = means_[i].rounds ? float(mean) : mean;
  }
  if (!critic_arrays_.empty()) FinishCriticLoss(whole.arrays);
  means_.clear();
  critic_arrays_.clear();
  overflows_ = !FitsMoments(squares);
}

void CpuEngine::HoldSteps(Number number, double limit) {
  outcome_.held = outcome_.held || Cell(number) > limit;
}

void CpuEngine::Step(nn::Adam* optimiser, std::span<nn::Module* const> changed, NextUse next_use) {
  if (!outcome_.held) outcome_.finite = outcome_.finite && !overflows_;
  if (Moves()) {
    optimiser->Step();
    taken_.push_back({optimiser, {changed.begin(), changed.end()}});
    for (nn::Module* module : changed) module->Refresh();
  }
  // Replicas write disjoint parts of the parameters, so all parts must be complete before any
  // replica computes with them.
  if (next_use == NextUse::kThisUpdate) replica_->Meet();
}

void CpuEngine::MoveTowards(float tau, std::span<const nn::Following> targets) {
  if (Moves()) nn::MoveTowards(tau, targets, replica_);
}

void CpuEngine::MoveAverage(float rate, const nn::ParameterSet& online, nn::ParameterSet* average) {
  if (Moves()) nn::MoveTowards(rate, online, average, *replica_);
}

}  // namespace shoal::learner
