// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/losses.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace shoal::learner {
namespace {

float SmallestAt(std::span<const float* const> q, int b) {
  float smallest = q[0][b];
  for (const float* values : q.subspan(1)) smallest = std::min(smallest, values[b]);
  return smallest;
}

// The first one on a tie.
size_t IndexOfSmallest(std::span<const float* const> q, int b) {
  size_t smallest = 0;
  for (size_t i = 1; i < q.size(); ++i) {
    if (!(q[smallest][b] <= q[i][b])) smallest = i;
  }
  return smallest;
}

double MeanAt(std::span<const float* const> q, int b) {
  double sum = 0;
  for (const float* values : q) sum += values[b];
  return sum / double(q.size());
}

double Huber(double error) {
  const double size = std::abs(error);
  return size <= 1 ? error * error : 2 * size - 1;
}

}  // namespace

void TdTargets(int batch, const TargetInputs& inputs, const TargetRates& rates, float* y) {
  for (int b = 0; b < batch; ++b) {
    float value = std::clamp(SmallestAt(inputs.next_q, b), rates.bounds.low, rates.bounds.high);
    if (inputs.next_log_prob != nullptr) value -= rates.temperature * inputs.next_log_prob[b];
    y[b] = rates.reward_scale * inputs.reward[b] + inputs.bootstrap[b] * rates.discount * value;
  }
}

void AverageCopies(int batch, int copies, int shifts, float* y) {
  if (copies == 1) return;
  const int averaged = shifts == 0 ? copies : shifts;
  for (int first = 0; first < batch; first += copies) {
    const double sum = std::accumulate(y + first, y + first + averaged, 0.0);
    std::fill_n(y + first, copies, float(sum / averaged));
  }
}

CriticLoss CriticLossForward(int batch, std::span<const float* const> q, const float* y,
                             const RowLoss& rows) {
  double loss = 0, q_sum = 0, y_sum = 0;
  for (int b = 0; b < batch; ++b) {
    double squares = 0, values = 0;
    for (const float* values_of_one : q) {
      const double error = double(values_of_one[b]) - y[b];
      squares += rows.huber ? Huber(error) : error * error;
      values += values_of_one[b];
    }
    loss += rows.weights != nullptr ? rows.weights[b] * squares : squares;
    q_sum += values;
    y_sum += y[b];
  }
  return {float(loss / batch), float(q_sum / (double(q.size()) * batch)), float(y_sum / batch)};
}

Summary Summarise(std::span<const float> values) {
  double sum = 0, squares = 0;
  for (const float value : values) sum += value;
  const double mean = sum / double(values.size());
  for (const float value : values) squares += (value - mean) * (value - mean);
  const auto [least, most] = std::ranges::minmax(values);
  return {mean, std::sqrt(squares / double(values.size())), least, most};
}

void CriticLossBackward(int batch, const float* q, const float* y, float* q_gradient,
                        const RowLoss& rows) {
  for (int b = 0; b < batch; ++b) {
    float error = q[b] - y[b];
    if (rows.huber) error = std::clamp(error, -1.f, 1.f);
    q_gradient[b] = 2 * error / float(batch);
    if (rows.weights != nullptr) q_gradient[b] *= rows.weights[b];
  }
}

void CriticErrors(int batch, std::span<const float* const> q, const float* y, float* errors) {
  for (int b = 0; b < batch; ++b) {
    errors[b] = std::abs(q[0][b] - y[b]);
    for (const float* values : q.subspan(1))
      errors[b] = std::max(errors[b], std::abs(values[b] - y[b]));
  }
}

float ActorLossForward(int batch, const float* log_prob, std::span<const float* const> q,
                       ActorValue value, float temperature) {
  double loss = 0;
  for (int b = 0; b < batch; ++b) {
    const double of_action = value == ActorValue::kMin ? SmallestAt(q, b) : MeanAt(q, b);
    loss += double(temperature) * log_prob[b] - of_action;
  }
  return float(loss / batch);
}

void ActorLossBackward(int batch, std::span<const float* const> q, ActorValue value,
                       std::span<float* const> q_gradients) {
  const bool of_all = value == ActorValue::kMean;
  const float share = of_all ? -1.f / (float(q.size()) * float(batch)) : -1.f / float(batch);
  for (int b = 0; b < batch; ++b) {
    const size_t smallest = IndexOfSmallest(q, b);
    for (size_t i = 0; i < q.size(); ++i) q_gradients[i][b] = of_all || i == smallest ? share : 0.f;
  }
}

float DeterministicActorLoss(int batch, std::span<const float* const> q,
                             std::span<const float> mean, double mean_penalty,
                             std::span<float* const> q_gradients) {
  double sum = 0;
  for (int b = 0; b < batch; ++b) {
    const size_t smallest = IndexOfSmallest(q, b);
    for (float* const gradient : q_gradients) gradient[b] = 0;
    q_gradients[smallest][b] = -1.f / float(batch);
    sum += q[smallest][b];
  }
  double loss = -sum / double(batch);
  if (mean_penalty > 0) {
    const double squares = std::inner_product(mean.begin(), mean.end(), mean.begin(), 0.0);
    loss += mean_penalty * squares / double(mean.size());
  }
  return float(loss);
}

double LabelLoss(std::span<const float> y, std::span<const float> labels, float weight,
                 std::span<float> gradient) {
  const float scale = 2 * weight / float(gradient.size());
  double squares = 0;
  for (size_t i = 0; i < gradient.size(); ++i) {
    const float difference = y[i] - labels[i];
    squares += double(difference) * difference;
    gradient[i] = scale * difference;
  }
  return squares;
}

double SaturatedShare(std::span<const float> actions) {
  const auto saturated =
      std::ranges::count_if(actions, [](float a) { return std::abs(a) > 0.99f; });
  return double(saturated) / double(actions.size());
}

float TemperatureLoss(float temperature, float entropy, float target_entropy) {
  return temperature * (entropy - target_entropy);
}

}  // namespace shoal::learner
