// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/sac/quantile_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "learner/agent/value_bounds.h"

namespace shoal::learner {
namespace {

// Row b of an array with `rows` rows.
template <class T>
std::span<T> RowOf(std::span<T> array, size_t b, size_t rows) {
  const size_t columns = array.size() / rows;
  return array.subspan(b * columns, columns);
}

float RowMean(std::span<const float> row) {
  return float(std::accumulate(row.begin(), row.end(), 0.0) / double(row.size()));
}

// The part of one quantile in the loss of a row, times the number of targets, and its derivative by
// the quantile.
struct QuantilePart {
  double loss = 0, derivative = 0;
};
QuantilePart PartOfQuantile(float quantile, float tau, std::span<const float> targets) {
  QuantilePart part;
  for (const float target : targets) {
    const float difference = target - quantile;
    const float weight = difference < 0 ? 1 - tau : tau;
    const float clipped = std::clamp(difference, -1.f, 1.f);
    part.loss += weight * clipped * (difference - clipped / 2);  // weight huber(difference)
    part.derivative -= weight * clipped;
  }
  return part;
}

}  // namespace

void QuantileTargets(const QuantileTargetInputs& inputs, float discount, const ValueBounds& bounds,
                     std::span<float> y, std::span<float> means) {
  const size_t rows = means.size(), kept = y.size() / rows;
  std::vector<float> pool;
  for (size_t b = 0; b < rows; ++b) {
    pool.clear();
    for (const std::span<const float> critic : inputs.next) {
      const std::span<const float> quantiles = RowOf(critic, b, rows);
      pool.insert(pool.end(), quantiles.begin(), quantiles.end());
    }
    const std::span<float> targets = RowOf(y, b, rows);
    if (std::ranges::any_of(pool, [](float value) { return std::isnan(value); })) {
      std::ranges::fill(targets, NAN);  // NaN has no place in an order
    } else {
      std::ranges::nth_element(pool, pool.begin() + ptrdiff_t(kept) - 1);
      for (size_t j = 0; j < kept; ++j) {
        const float value = std::clamp(pool[j], bounds.low, bounds.high);
        targets[j] = inputs.base[b] + inputs.bootstrap[b] * discount * value;
      }
    }
    means[b] = RowMean(targets);
  }
}

void QuantileLoss(std::span<const float> q, std::span<const float> y, std::span<float> losses,
                  std::span<float> gradient) {
  const size_t rows = losses.size(), count = q.size() / rows, targets = y.size() / rows;
  const double share = 1 / (double(count) * double(targets));
  for (size_t b = 0; b < rows; ++b) {
    for (size_t m = 0; m < count; ++m) {
      const float tau = (float(m) + 0.5f) / float(count);
      const QuantilePart part = PartOfQuantile(q[b * count + m], tau, RowOf(y, b, rows));
      losses[b] += float(share * part.loss);
      gradient[b * count + m] = float(share / double(rows) * part.derivative);
    }
  }
}

std::unique_ptr<QuantileValues> QuantileValues::Make(const Config& config, Engine* engine) {
  if (config.sac.quantiles == 0) return nullptr;
  return std::make_unique<QuantileValues>(config, engine);
}

QuantileValues::QuantileValues(const Config& config, Engine* engine)
    : engine_(engine),
      discount_(float(config.learner.discount)),
      bounds_(ValueBoundsOf(config.learner)),
      zeros_(engine->NewArray(1)),
      targets_(engine->NewArray(config.sac.critics *
                                (config.sac.quantiles - config.sac.dropped_quantiles))),
      target_means_(engine->NewArray(1)),
      row_losses_(engine->NewArray(1)),
      loss_(engine->NewNumber()) {
  for (int i = 0; i < config.sac.critics; ++i) {
    means_.push_back(engine->NewArray(1));
    mean_gradients_.push_back(engine->NewArray(1));
  }
}

void QuantileValues::ComputeTargets(Array base, Array bootstrap, std::span<const Array> next) {
  std::vector<Array> inputs{base, bootstrap};
  inputs.insert(inputs.end(), next.begin(), next.end());
  engine_->OnHost(inputs, std::array{targets_, target_means_},
                  [discount = discount_, bounds = bounds_](const auto& in, const auto& out) {
                    QuantileTargets({.next = in.subspan(2), .base = in[0], .bootstrap = in[1]},
                                    discount, bounds, out[0], out[1]);
                  });
}

void QuantileValues::CriticLoss(std::span<const Array> q, std::span<const Array> q_gradients,
                                const CriticNumbers& figures) {
  engine_->CriticLoss(Means(q), target_means_, /*rows=*/{}, mean_gradients_, figures);
  std::vector<Array> inputs{targets_}, outputs{row_losses_};
  inputs.insert(inputs.end(), q.begin(), q.end());
  outputs.insert(outputs.end(), q_gradients.begin(), q_gradients.end());
  engine_->OnHost(inputs, outputs, [](const auto& in, const auto& out) {
    std::ranges::fill(out[0], 0.f);
    for (size_t i = 1; i < in.size(); ++i) QuantileLoss(in[i], in[0], out[0], out[i]);
  });
  engine_->Mean(row_losses_, loss_);
}

std::span<const Array> QuantileValues::Means(std::span<const Array> q) {
  engine_->OnHost(q, means_, [](const auto& in, const auto& out) {
    for (size_t i = 0; i < in.size(); ++i) {
      const size_t rows = out[i].size();
      for (size_t b = 0; b < rows; ++b) out[i][b] = RowMean(RowOf(in[i], b, rows));
    }
  });
  return means_;
}

void QuantileValues::SpreadGradients(std::span<const Array> q_gradients) {
  engine_->OnHost(mean_gradients_, q_gradients, [](const auto& in, const auto& out) {
    for (size_t i = 0; i < in.size(); ++i) {
      const size_t rows = in[i].size();
      for (size_t b = 0; b < rows; ++b) {
        const std::span<float> quantiles = RowOf(out[i], b, rows);
        std::ranges::fill(quantiles, in[i][b] / float(quantiles.size()));
      }
    }
  });
}

}  // namespace shoal::learner
