// SPDX-License-Identifier: Apache-2.0
// The operations between networks: each one appends a kernel to the update's list.
#include <cmath>

#include "common/base/check.h"
#include "common/nn/device_memory.h"
#include "learner/device/device_engine.h"
#include "learner/engine/draw_subset.h"

namespace shoal::learner::device {
namespace {

using nn::AddressOf;

template <size_t n>
void SetAddresses(std::span<const Array> arrays, const float* (&addresses)[n]) {
  CHECK(arrays.size() <= n) << arrays.size() << " arrays";
  for (size_t i = 0; i < arrays.size(); ++i) addresses[i] = AddressOf(arrays[i]);
}

template <size_t n>
void SetAddresses(std::span<const Array> arrays, float* (&addresses)[n]) {
  CHECK(arrays.size() <= n) << arrays.size() << " arrays";
  for (size_t i = 0; i < arrays.size(); ++i) addresses[i] = AddressOf(arrays[i]);
}

kernels::CriticFigures FiguresOf(const CriticNumbers& numbers) {
  return {.loss = AddressOf(numbers.loss),
          .q_mean = AddressOf(numbers.q_mean),
          .target_mean = AddressOf(numbers.target_mean),
          .q1_mean = AddressOf(numbers.q1_mean),
          .q1_std = AddressOf(numbers.q1_std),
          .q2_mean = AddressOf(numbers.q2_mean),
          .q2_std = AddressOf(numbers.q2_std),
          .q_min_mean = AddressOf(numbers.q_min_mean),
          .q_min_std = AddressOf(numbers.q_min_std),
          .q_min_min = AddressOf(numbers.q_min_min),
          .q_min_max = AddressOf(numbers.q_min_max)};
}

kernels::ClippedPolicyFigures FiguresOf(const ClippedPolicyNumbers& numbers) {
  return {.policy = AddressOf(numbers.policy),
          .value = AddressOf(numbers.value),
          .total = AddressOf(numbers.total),
          .rounded_total = AddressOf(numbers.rounded_total),
          .approx_kl = AddressOf(numbers.approx_kl),
          .clip_fraction = AddressOf(numbers.clip_fraction)};
}

}  // namespace

// ---- Inputs ----

void DeviceEngine::JoinColumns(Array left, Array right,
                               std::span<const ObservationSpec::Range> ranges, Array joined) {
  kernels::CopyColumns copy;
  copy.rows = rows();
  CHECK(int(ranges.size()) < kernels::CopyColumns::kMostPieces) << ranges.size() << " ranges";
  const kernels::Target to{AddressOf(joined), nullptr};
  const int width = ColumnsOf(joined), left_width = ColumnsOf(left);
  int column = left_width;
  if (left_width > 0) {
    copy.Add({AddressOf(left), left_width, 0, left_width, to, width, 0, /*adds=*/false});
  }
  for (const ObservationSpec::Range& range : ranges) {
    copy.Add({AddressOf(right), ColumnsOf(right), range.first, range.size, to, width, column,
              /*adds=*/false});
    column += range.size;
  }
  workspace_.Add(copy);
}

void DeviceEngine::SplitColumns(Array joined, Array left, Array right) {
  kernels::CopyColumns copy;
  copy.rows = rows();
  int column = 0;
  for (const Array part : {left, right}) {
    const int width = ColumnsOf(part);
    if (width == 0) continue;
    copy.Add({AddressOf(joined), ColumnsOf(joined), column, width,
              kernels::Target{AddressOf(part), nullptr}, width, 0, /*adds=*/false});
    column += width;
  }
  workspace_.Add(copy);
}

void DeviceEngine::GatherLabels(Array observed, Array privileged,
                                std::span<const LabelColumns> columns, float unit, Array labels) {
  CHECK(int(columns.size()) <= kernels::GatherLabels::kMostLabels) << columns.size() << " labels";
  kernels::GatherLabels gather;
  gather.rows = rows();
  gather.label_count = int(columns.size());
  gather.unit = unit;
  gather.labels = AddressOf(labels);
  const auto column = [&](const LabelColumns::Column& of) -> kernels::GatherLabels::Column {
    const Array from = of.observed ? observed : privileged;
    return {AddressOf(from), ColumnsOf(from), int(of.at)};
  };
  for (size_t i = 0; i < columns.size(); ++i) {
    gather.columns[i].number = column(columns[i].number);
    if (columns[i].minus) gather.columns[i].minus = column(*columns[i].minus);
  }
  workspace_.Add(gather);
}

void DeviceEngine::Standardise(Array x, Moments moments, float variance_floor, Array y) {
  workspace_.Add(kernels::Standardise{.rows = rows(),
                                      .width = ColumnsOf(x),
                                      .x = AddressOf(x),
                                      .moments = AddressOf(moments),
                                      .variance_floor = variance_floor,
                                      .y = AddressOf(y)});
}

void DeviceEngine::AddToMoments(std::span<const float> vectors, Moments moments) {
  const auto width = size_t(moments.size()) / 2;
  if (!updating_) BeginInputs();
  const kernels::AddToMoments add{.rows = int(vectors.size() / width),
                                  .width = int(width),
                                  .vectors = landing().Add(vectors),
                                  .moments = AddressOf(moments),
                                  .flags = updating_ ? &results_->flags : nullptr,
                                  .finished = counter_};
  if (!updating_) landing().Send();
  workspace_.Add(add);
  if (!updating_) landing().MarkUsed();
}

// ---- Actions ----

void DeviceEngine::SampleSquashedGaussian(Array mean, Array log_std, Random* random,
                                          const SquashedSample& sample) {
  const int actions = ColumnsOf(mean);
  const std::vector<double> normals = alone_.Normals(rows(), actions, random);
  const std::vector<float> noise(normals.begin(), normals.end());
  workspace_.Add(
      kernels::SampleSquashedGaussian{.rows = rows(),
                                      .actions = actions,
                                      .mean = AddressOf(mean),
                                      .log_std = AddressOf(log_std),
                                      .noise = landing().Add(std::span<const float>(noise)),
                                      .scaled_noise = AddressOf(sample.scaled_noise),
                                      .action = AddressOf(sample.action),
                                      .log_prob = AddressOf(sample.log_prob)});
}

void DeviceEngine::SquashedGaussianBackward(const SquashedSample& sample, Array action_gradient,
                                            Number temperature, Array mean_gradient,
                                            Array log_std_gradient) {
  workspace_.Add(
      kernels::SquashedGaussianBackward{.rows = rows(),
                                        .actions = ColumnsOf(sample.action),
                                        .scaled_noise = AddressOf(sample.scaled_noise),
                                        .action = AddressOf(sample.action),
                                        .action_gradient = AddressOf(action_gradient),
                                        .temperature = AddressOf(temperature),
                                        .mean_gradient = AddressOf(mean_gradient),
                                        .log_std_gradient = AddressOf(log_std_gradient)});
}

void DeviceEngine::SquashedGaussianFigures(const SquashedSample& sample, Number entropy,
                                           Number saturation) {
  workspace_.Add(kernels::SquashedGaussianFigures{.rows = rows(),
                                                  .actions = ColumnsOf(sample.action),
                                                  .log_prob = AddressOf(sample.log_prob),
                                                  .action = AddressOf(sample.action),
                                                  .entropy = AddressOf(entropy),
                                                  .saturation = AddressOf(saturation)});
}

void DeviceEngine::AddClippedNoise(Array action, Number sigma, double limit, Random* random,
                                   Array noisy) {
  const std::vector<double> normals = alone_.Normals(rows(), ColumnsOf(action), random);
  workspace_.Add(kernels::AddClippedNoise{.n = action.size(),
                                          .sigma = AddressOf(sigma),
                                          .limit = limit,
                                          .action = AddressOf(action),
                                          .noise = landing().Add(std::span<const double>(normals)),
                                          .noisy = AddressOf(noisy)});
}

// ---- Targets and losses ----

void DeviceEngine::Targets(const TargetTerms& terms, Array y) {
  kernels::Targets targets{.rows = rows(),
                           .critics = int(terms.next_q.size()),
                           .reward = AddressOf(terms.reward),
                           .bootstrap = AddressOf(terms.bootstrap)};
  SetAddresses(terms.next_q, targets.next_q);
  if (terms.drawn > 0) {
    // The draw travels with the inputs, because commands contain no number that changes.
    const auto drawn = DrawSubset(int(terms.next_q.size()), terms.drawn, terms.random);
    targets.critics = terms.drawn;
    targets.chosen = landing().Add(std::span<const int32_t>(drawn));
  }
  targets.next_log_prob = AddressOf(terms.next_log_prob);
  targets.temperature = AddressOf(terms.temperature);
  targets.reward_scale = terms.reward_scale;
  targets.discount = terms.discount;
  targets.low = terms.bounds.low;
  targets.high = terms.bounds.high;
  targets.y = AddressOf(y);
  workspace_.Add(targets);
}

void DeviceEngine::AverageCopies(int copies, int shifts, Array y) {
  if (copies == 1) return;
  workspace_.Add(kernels::AverageCopies{.rows = rows(),
                                        .copies = copies,
                                        .averaged = shifts == 0 ? copies : shifts,
                                        .y = AddressOf(y)});
}

void DeviceEngine::CriticLoss(std::span<const Array> q, Array y, const CriticRows& of_rows,
                              std::span<const Array> q_gradients, const CriticNumbers& figures) {
  CHECK(q.size() == q_gradients.size()) << q.size();
  kernels::CriticLoss loss;
  loss.rows = rows();
  loss.critics = int(q.size());
  SetAddresses(q, loss.q);
  SetAddresses(q_gradients, loss.q_gradient);
  loss.y = AddressOf(y);
  loss.weights = AddressOf(of_rows.weights);
  loss.huber = of_rows.huber;
  if (of_rows.returns_errors) {
    if (errors_ == nullptr) errors_ = workspace_.New<float>(rows());
    loss.errors = errors_;
    returns_errors_ = true;
  }
  loss.figures = FiguresOf(figures);
  workspace_.Add(loss);
}

void DeviceEngine::EntropyActorLoss(Array log_prob, std::span<const Array> q, ActorValue value,
                                    Number temperature, std::span<const Array> q_gradients,
                                    Number loss) {
  CHECK(q.size() == q_gradients.size()) << q.size();
  kernels::EntropyActorLoss actor_loss{.rows = rows(),
                                       .critics = int(q.size()),
                                       .of_mean = value == ActorValue::kMean,
                                       .log_prob = AddressOf(log_prob)};
  SetAddresses(q, actor_loss.q);
  actor_loss.temperature = AddressOf(temperature);
  SetAddresses(q_gradients, actor_loss.q_gradient);
  actor_loss.loss = AddressOf(loss);
  workspace_.Add(actor_loss);
}

void DeviceEngine::DeterministicActorLoss(std::span<const Array> q, Array mean, Array action,
                                          double mean_penalty, std::span<const Array> q_gradients,
                                          Number loss, Number saturation) {
  CHECK(!q.empty() && q.size() == q_gradients.size()) << q.size();
  kernels::DeterministicActorLoss kernel{.rows = rows(),
                                         .actions = ColumnsOf(action),
                                         .critics = int(q.size()),
                                         .mean = AddressOf(mean),
                                         .action = AddressOf(action),
                                         .mean_penalty = mean_penalty,
                                         .loss = AddressOf(loss),
                                         .saturation = AddressOf(saturation)};
  SetAddresses(q, kernel.q);
  SetAddresses(q_gradients, kernel.q_gradient);
  workspace_.Add(kernel);
}

void DeviceEngine::LabelLoss(Array y, Array labels, float weight, float unit, Array gradient,
                             Number mean_square) {
  workspace_.Add(kernels::LabelLoss{.n = y.size(),
                                    .y = AddressOf(y),
                                    .labels = AddressOf(labels),
                                    .weight = weight,
                                    .unit = unit,
                                    .gradient = {AddressOf(gradient), nullptr},
                                    .mean_square = AddressOf(mean_square)});
}

void DeviceEngine::ClippedPolicyLoss(const ClippedPolicyTerms& terms, nn::ParameterSet* log_std,
                                     Array mean_gradient, Array value_gradient,
                                     const ClippedPolicyNumbers& figures) {
  const DeviceParameters& deviations = Use(*log_std, /*changes=*/false, nullptr);
  const int actions = ColumnsOf(terms.mean);
  const ClippedPolicyMemory& memory = MemoryOfClippedPolicy(actions);
  workspace_.Add(kernels::PrepareClippedPolicy{.rows = rows(),
                                               .actions = actions,
                                               .normalise = terms.normalise_advantages,
                                               .advantage = AddressOf(terms.advantage),
                                               .log_std = deviations.values(),
                                               .inverse_sigma = memory.inverse_sigma,
                                               .constants = memory.constants});
  workspace_.Add(kernels::ClippedPolicyRows{.rows = rows(),
                                            .actions = actions,
                                            .mean = AddressOf(terms.mean),
                                            .drawn_action = AddressOf(terms.drawn_action),
                                            .inverse_sigma = memory.inverse_sigma,
                                            .old_log_prob = AddressOf(terms.old_log_prob),
                                            .advantage = AddressOf(terms.advantage),
                                            .value = AddressOf(terms.value),
                                            .old_value = AddressOf(terms.old_value),
                                            .target = AddressOf(terms.target),
                                            .constants = memory.constants,
                                            .clip = AddressOf(terms.clip),
                                            .value_clip = terms.value_clip,
                                            .value_weight = terms.value_weight,
                                            .entropy_weight = terms.entropy_weight,
                                            .mean_gradient = AddressOf(mean_gradient),
                                            .value_gradient = AddressOf(value_gradient),
                                            .log_prob_gradient = memory.log_prob_gradient,
                                            .partials = memory.partials,
                                            .finished = counter_,
                                            .figures = FiguresOf(figures)});
  workspace_.Add(kernels::LogStdGradient{.rows = rows(),
                                         .actions = actions,
                                         .mean = AddressOf(terms.mean),
                                         .drawn_action = AddressOf(terms.drawn_action),
                                         .inverse_sigma = memory.inverse_sigma,
                                         .log_prob_gradient = memory.log_prob_gradient,
                                         .entropy_weight = terms.entropy_weight,
                                         .gradient = deviations.gradients()});
}

const DeviceEngine::ClippedPolicyMemory& DeviceEngine::MemoryOfClippedPolicy(int actions) {
  const auto [memory, is_new] = clipped_policies_.try_emplace(actions);
  if (is_new) {
    const int blocks = kernels::ClippedPolicyRows::BlocksFor(rows());
    memory->second = {.inverse_sigma = workspace_.New<double>(actions),
                      .constants = workspace_.New<kernels::ClippedPolicyConstants>(1),
                      .log_prob_gradient = workspace_.New<double>(rows()),
                      .partials = workspace_.New<kernels::ClippedPolicyRows::Terms>(blocks)};
  }
  return memory->second;
}

void DeviceEngine::GaussianFigures(const nn::ParameterSet& log_std, Number deviation,
                                   Number entropy) {
  workspace_.Add(
      kernels::GaussianFigures{.actions = int(log_std.specs()[0].shape[0]),
                               .log_std = Use(log_std, /*changes=*/false, nullptr).values(),
                               .deviation = AddressOf(deviation),
                               .entropy = AddressOf(entropy)});
}

void DeviceEngine::OnHost(std::span<const Array>, std::span<const Array>, const HostOperation&) {
  CHECK(false) << "a device runs no operations on the host";
}

void DeviceEngine::Mean(Array values, Number mean) {
  workspace_.Add(
      kernels::Mean{.n = values.size(), .values = AddressOf(values), .mean = AddressOf(mean)});
}

// ---- Temperature ----

void DeviceEngine::Temperature(const nn::ParameterSet& log_temperature, Number temperature) {
  const DeviceParameters& parameters = Use(log_temperature, /*changes=*/false, nullptr);
  workspace_.Add(kernels::Temperature{.log_temperature = parameters.values(),
                                      .temperature = AddressOf(temperature)});
}

void DeviceEngine::TemperatureLoss(Number temperature, Number entropy, float target_entropy,
                                   Number loss) {
  workspace_.Add(kernels::TemperatureLoss{.temperature = AddressOf(temperature),
                                          .entropy = AddressOf(entropy),
                                          .target_entropy = target_entropy,
                                          .loss = AddressOf(loss)});
}

void DeviceEngine::StepTemperature(Number loss, double least, nn::ParameterSet* log_temperature,
                                   nn::Adam* optimiser) {
  Use(*log_temperature, /*changes=*/true, nullptr);
  const DeviceAdam& adam = Use(optimiser);
  stepped_.push_back(optimiser);
  workspace_.Add(
      kernels::StepTemperature{.set = AdamSetOf(*optimiser, 0),
                               .options = OptionsOf(*optimiser),
                               .loss = AddressOf(loss),
                               .least = float(std::log(least)),  // log(0) is -inf: no bound
                               .state = adam.state(),
                               .flags = &results_->flags});
}

}  // namespace shoal::learner::device
