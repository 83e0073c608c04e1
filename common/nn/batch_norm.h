// SPDX-License-Identifier: Apache-2.0
// Batch normalisation of a map's channels, then a skip connection and ReLU if the plan has them.
//
//   y[b, c, i, j] = max(0, weight_c (x[b, c, i, j] - mean_c) / sqrt(var_c + 1e-5) + bias_c
//                          + skip[b, c, i, j])
//
//   Statistics::kBatch     mean_c, var_c over the n = B h w values of channel c, and
//                          running_mean' = 0.9 running_mean + 0.1 mean
//                          running_var'  = 0.9 running_var  + 0.1 var n / (n - 1)
//   Statistics::kRunning   mean_c, var_c = running_mean_c, running_var_c
//
// The optimiser's next step applies the running statistics of the latest kBatch pass together with
// the gradients. An update without a step does not change the statistics.
//
// Source: Ioffe and Szegedy 2015, arXiv:1502.03167; constants of PyTorch's BatchNorm2d.
// Shapes: x, skip, y (B, C, h, w) in the compute type; all values per channel (C) f32.
#pragma once

#include <vector>

#include "common/nn/map_layer.h"

namespace shoal::nn {

// Memory of a map that a layer reads, and memory to which the layer writes the map's gradient. Each
// may be empty.
struct MapSource {
  dnnl::memory values, gradient;
};

class BatchNorm final : public MapLayer {
 public:
  // `plan`: the convolution that writes `source`. Each gradient has the same shape and layout as
  // its values; it is overwritten, not accumulated. skip: empty if there is no skip connection.
  BatchNorm(const LayerContext& context, const LayerPlan& plan, const MapSource& source,
            const MapSource& skip);

  void Refresh() override;
  void Forward(Statistics statistics) override;
  // Backward pass of the latest Forward, whose statistics must have been kBatch.
  void Backward() override;

 private:
  void BuildTraining(const LayerContext& context, const MapSource& source, const MapSource& skip);
  void MeasureRunning();

  bool relu_, measured_ = false;  // measured: the latest Forward was kBatch
  int64_t count_;                 // n
  Parameter weight_, bias_, running_mean_, running_variance_;
  dnnl::memory weight_values_, bias_values_, running_mean_values_, running_variance_values_;
  dnnl::memory mean_, variance_;  // statistics of the batch
  Relayout skip_;                 // in the output's layout
  Op by_running_, by_batch_, backward_;
  Op skip_gradient_;
  bool has_skip_gradient_ = false;
};

}  // namespace shoal::nn
