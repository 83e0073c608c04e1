#include "common/nn/spatial_softmax.h"

#include "common/base/cpu_clones.h"
#include "common/nn/parallel.h"
#include "common/nn/primitive_descs.h"

namespace shoal::nn {
namespace {

using dnnl::memory;

float Coordinate(int at, int side) { return side == 1 ? 0.f : 2 * float(at) / float(side - 1) - 1; }

SHOAL_CPU_CLONES void Scale(const float* x, int n, float by, float* y) {
  for (int i = 0; i < n; ++i) y[i] = by * x[i];
}

// The means of two coordinates.
SHOAL_CPU_CLONES void MeanPoint(const float* p, int n, const float* across, const float* down,
                                float* point) {
  float x = 0, y = 0;
#pragma omp simd reduction(+ : x, y)
  for (int i = 0; i < n; ++i) {
    x += p[i] * across[i];
    y += p[i] * down[i];
  }
  point[0] = x;
  point[1] = y;
}

// dx = s p (g - mean of g), g the gradient along a pixel's coordinates.
struct PointGradient {
  float across, down, mean;  // dy[0], dy[1], and of both with the point itself
};
SHOAL_CPU_CLONES void MeanPointBackward(const float* p, int n, const float* across,
                                        const float* down, const PointGradient& dy, float sharpness,
                                        float* dx) {
  for (int i = 0; i < n; ++i) {
    dx[i] = sharpness * p[i] * (dy.across * across[i] + dy.down * down[i] - dy.mean);
  }
}

float* Floats(const memory& values) { return static_cast<float*>(values.get_data_handle()); }

}  // namespace

SpatialSoftmax::SpatialSoftmax(const LayerContext& context, const LayerPlan& plan,
                               const memory& source, const memory& source_gradient)
    : planes_(context.batch * plan.input.channels),
      pixels_(plan.input.height * plan.input.width),
      sharpness_(float(plan.sharpness)) {
  const MapShape& from = plan.input;
  for (int i = 0; i < from.height; ++i) {
    for (int j = 0; j < from.width; ++j) {
      across_.push_back(Coordinate(j, from.width));
      down_.push_back(Coordinate(i, from.height));
    }
  }
  const memory::desc map({context.batch, from.channels, from.height, from.width},
                         memory::data_type::f32, memory::format_tag::nchw);
  source_ = Relayout::Before(source, map, context.scratchpad);
  const memory::desc rows = PlainF32({planes_, pixels_});
  probabilities_ = MakeMemory(rows);
  const auto kind =
      context.training ? dnnl::prop_kind::forward_training : dnnl::prop_kind::forward_inference;
  softmax_ =
      Op(DescribeSoftmax(kind, rows, /*axis=*/1),
         {{DNNL_ARG_SRC, probabilities_}, {DNNL_ARG_DST, probabilities_}}, context.scratchpad);
  const auto points = [&](memory::data_type type) {
    return memory::desc({context.batch, from.channels, 1, 2}, type, memory::format_tag::nchw);
  };
  const memory::desc compute = points(ComputeType(context.precision));
  const memory::desc f32 = points(memory::data_type::f32);
  output_ = MakeMemory(compute);
  points_ = Relayout::After(f32, output_, context.scratchpad);
  if (!context.training) return;
  output_gradient_ = MakeMemory(compute);
  points_gradient_ = Relayout::Before(output_gradient_, f32, context.scratchpad);
  has_source_gradient_ = bool(source_gradient);
  if (!has_source_gradient_) return;
  source_gradient_ = Relayout::After(map, source_gradient, context.scratchpad);
}

void SpatialSoftmax::Forward(Statistics) {
  source_.Run();
  const float* x = Floats(source_.memory());
  float* p = Floats(probabilities_);
  ParallelFor(planes_, [&](int begin, int end) {
    const int64_t first = int64_t{begin} * pixels_;
    Scale(x + first, (end - begin) * pixels_, sharpness_, p + first);
  });
  softmax_.Run();
  float* y = Floats(points_.memory());
  ParallelFor(planes_, [&](int begin, int end) {
    for (int plane = begin; plane < end; ++plane) {
      MeanPoint(p + int64_t{plane} * pixels_, pixels_, across_.data(), down_.data(),
                y + int64_t{plane} * 2);
    }
  });
  points_.Run();
}

void SpatialSoftmax::Backward() {
  if (!has_source_gradient_) return;
  points_gradient_.Run();
  const float* p = Floats(probabilities_);
  float* dx = Floats(source_gradient_.memory());
  ParallelFor(planes_, [&](int begin, int end) {
    for (int plane = begin; plane < end; ++plane) {
      const float* y = Floats(points_.memory()) + int64_t{plane} * 2;
      const float* dy = Floats(points_gradient_.memory()) + int64_t{plane} * 2;
      const PointGradient gradient{dy[0], dy[1], dy[0] * y[0] + dy[1] * y[1]};
      const int64_t first = int64_t{plane} * pixels_;
      MeanPointBackward(p + first, pixels_, across_.data(), down_.data(), gradient, sharpness_,
                        dx + first);
    }
  });
  source_gradient_.Run();
}

}  // namespace shoal::nn
