// SPDX-License-Identifier: Apache-2.0
// Maps are stored in blocks of channels (nChw16c in oneDNN). Convolutions have this output layout
// on CPUs with AVX-512. A pixel of sixteen channels is one vector with a channel in each lane.
#include "common/nn/spatial_softmax.h"

#include "common/base/cpu_clones.h"
#include "common/nn/bf16.h"
#include "common/nn/exp_of_negative.h"
#include "common/nn/parallel.h"
#include "common/nn/primitive_descs.h"

namespace shoal::nn {
namespace {

using dnnl::memory;

constexpr int kLanes = 16;

float Coordinate(int at, int side) { return side == 1 ? 0.f : 2 * float(at) / float(side - 1) - 1; }

// Values that all maps of a layer share.
struct Grid {
  int pixels;
  const float *across, *down;  // (pixels)
  float sharpness;
};

// A block of maps: x (pixels, lanes), the others (lanes).
template <class T>
[[gnu::always_inline]] inline void PointsOfBlock(const Grid& grid, const T* __restrict x,
                                                 float* __restrict largest, float* __restrict total,
                                                 float* __restrict px, float* __restrict py) {
  float top[kLanes], sum[kLanes] = {}, right[kLanes] = {}, below[kLanes] = {};
  for (int l = 0; l < kLanes; ++l) top[l] = ToFloat(x[l]);
  for (int i = 1; i < grid.pixels; ++i) {
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) {
      const float value = ToFloat(x[i * kLanes + l]);
      top[l] = value < top[l] ? top[l] : value;
    }
  }
  for (int i = 0; i < grid.pixels; ++i) {
    const float across = grid.across[i], down = grid.down[i];
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) {
      const float e = ExpOfNegative(grid.sharpness * (ToFloat(x[i * kLanes + l]) - top[l]));
      sum[l] += e;
      right[l] += e * across;
      below[l] += e * down;
    }
  }
  for (int l = 0; l < kLanes; ++l) {
    largest[l] = top[l];
    total[l] = sum[l];
    px[l] = right[l] / sum[l];
    py[l] = below[l] / sum[l];
  }
}

// Gradients along the coordinates of a block's points, and the product of both with the points
// themselves: (lanes).
struct BlockGradient {
  float across[kLanes], down[kLanes], mean[kLanes];
};

// dx = s p (g - mean of g), where g is the gradient along a pixel's coordinates.
template <class T>
[[gnu::always_inline]] inline void PointsOfBlockBackward(const Grid& grid, const T* __restrict x,
                                                         const float* __restrict largest,
                                                         const float* __restrict total,
                                                         const BlockGradient& dy,
                                                         T* __restrict dx) {
  float top[kLanes], factor[kLanes];
  for (int l = 0; l < kLanes; ++l) {
    top[l] = largest[l];
    factor[l] = grid.sharpness / total[l];
  }
  for (int i = 0; i < grid.pixels; ++i) {
    const float across = grid.across[i], down = grid.down[i];
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) {
      const float e = ExpOfNegative(grid.sharpness * (ToFloat(x[i * kLanes + l]) - top[l]));
      const float g = dy.across[l] * across + dy.down[l] * down - dy.mean[l];
      Store(factor[l] * e * g, dx + i * kLanes + l);
    }
  }
}

SHOAL_CPU_CLONES void Points(const Grid& grid, const float* x, float* largest, float* total,
                             float* px, float* py) {
  PointsOfBlock(grid, x, largest, total, px, py);
}
SHOAL_CPU_CLONES void Points(const Grid& grid, const uint16_t* x, float* largest, float* total,
                             float* px, float* py) {
  PointsOfBlock(grid, x, largest, total, px, py);
}
SHOAL_CPU_CLONES void PointsBackward(const Grid& grid, const float* x, const float* largest,
                                     const float* total, const BlockGradient& dy, float* dx) {
  PointsOfBlockBackward(grid, x, largest, total, dy, dx);
}
SHOAL_CPU_CLONES void PointsBackward(const Grid& grid, const uint16_t* x, const float* largest,
                                     const float* total, const BlockGradient& dy, uint16_t* dx) {
  PointsOfBlockBackward(grid, x, largest, total, dy, dx);
}

template <class T>
T* Values(const memory& values) {
  return static_cast<T*>(values.get_data_handle());
}

}  // namespace

SpatialSoftmax::SpatialSoftmax(const LayerContext& context, const LayerPlan& plan,
                               const memory& source, const memory& source_gradient)
    : bf16_(context.precision == Precision::kBf16),
      images_(context.batch),
      channels_(plan.input.channels),
      blocks_((channels_ + kLanes - 1) / kLanes),
      pixels_(plan.input.height * plan.input.width),
      sharpness_(float(plan.sharpness)),
      largest_(size_t(images_) * size_t(blocks_) * kLanes),
      total_(largest_) {
  const MapShape& from = plan.input;
  for (int i = 0; i < from.height; ++i) {
    for (int j = 0; j < from.width; ++j) {
      across_.push_back(Coordinate(j, from.width));
      down_.push_back(Coordinate(i, from.height));
    }
  }
  const memory::data_type compute = ComputeType(context.precision);
  const memory::desc map({images_, channels_, from.height, from.width}, compute,
                         memory::format_tag::nChw16c);
  source_ = Relayout::Before(source, map, context.scratchpad);
  const auto points = [&](memory::data_type type) {
    return memory::desc({images_, channels_, 1, 2}, type, memory::format_tag::nchw);
  };
  const memory::desc f32 = points(memory::data_type::f32);
  output_ = MakeMemory(points(compute));
  points_ = Relayout::After(f32, output_, context.scratchpad);
  if (!context.training) return;
  output_gradient_ = MakeMemory(points(compute));
  points_gradient_ = Relayout::Before(output_gradient_, f32, context.scratchpad);
  has_source_gradient_ = bool(source_gradient);
  if (!has_source_gradient_) return;
  source_gradient_ = Relayout::After(map, source_gradient, context.scratchpad);
}

template <class T>
void SpatialSoftmax::ForwardMaps() {
  const Grid grid{pixels_, across_.data(), down_.data(), sharpness_};
  const T* x = Values<T>(source_.memory());
  float* y = Values<float>(points_.memory());
  ParallelFor(images_ * blocks_, [&](int begin, int end) {
    float across[kLanes], down[kLanes];
    for (int block = begin; block < end; ++block) {
      const int64_t lanes = int64_t{block} * kLanes;
      Points(grid, x + lanes * pixels_, &largest_[size_t(lanes)], &total_[size_t(lanes)], across,
             down);
      const int image = block / blocks_, first = block % blocks_ * kLanes;
      for (int l = 0; l < kLanes && first + l < channels_; ++l) {
        float* point = y + (int64_t{image} * channels_ + first + l) * 2;
        point[0] = across[l];
        point[1] = down[l];
      }
    }
  });
}

template <class T>
void SpatialSoftmax::BackwardMaps() {
  const Grid grid{pixels_, across_.data(), down_.data(), sharpness_};
  const T* x = Values<T>(source_.memory());
  T* dx = Values<T>(source_gradient_.memory());
  ParallelFor(images_ * blocks_, [&](int begin, int end) {
    for (int block = begin; block < end; ++block) {
      const int image = block / blocks_, first = block % blocks_ * kLanes;
      BlockGradient gradient{};  // 0 for the lanes beyond the last channel
      for (int l = 0; l < kLanes && first + l < channels_; ++l) {
        const int64_t point = (int64_t{image} * channels_ + first + l) * 2;
        const float* y = Values<float>(points_.memory()) + point;
        const float* dy = Values<float>(points_gradient_.memory()) + point;
        gradient.across[l] = dy[0];
        gradient.down[l] = dy[1];
        gradient.mean[l] = dy[0] * y[0] + dy[1] * y[1];
      }
      const int64_t lanes = int64_t{block} * kLanes;
      PointsBackward(grid, x + lanes * pixels_, &largest_[size_t(lanes)], &total_[size_t(lanes)],
                     gradient, dx + lanes * pixels_);
    }
  });
}

void SpatialSoftmax::Forward(Statistics) {
  source_.Run();
  if (bf16_) {
    ForwardMaps<uint16_t>();
  } else {
    ForwardMaps<float>();
  }
  points_.Run();
}

void SpatialSoftmax::Backward() {
  if (!has_source_gradient_) return;
  points_gradient_.Run();
  if (bf16_) {
    BackwardMaps<uint16_t>();
  } else {
    BackwardMaps<float>();
  }
  source_gradient_.Run();
}

}  // namespace shoal::nn
