// SPDX-License-Identifier: Apache-2.0
#include "common/nn/average_pool.h"

#include <algorithm>
#include <vector>

#include "common/nn/bf16.h"
#include "common/nn/parallel.h"
#include "common/nn/primitive_descs.h"

namespace shoal::nn {
namespace {

using dnnl::memory;

struct Window {
  int begin, end;
};

// The window of output `i`, of `outputs` along a side of `inputs`.
Window WindowOf(int i, int inputs, int outputs) {
  return {static_cast<int>(int64_t{i} * inputs / outputs),
          static_cast<int>((int64_t{i + 1} * inputs + outputs - 1) / outputs)};
}

// Calls visit(output index, source index, 1 / size of the window) for every pair in one plane.
template <class Visit>
void ForPairs(const MapShape& from, const MapShape& to, const Visit& visit) {
  for (int i = 0; i < to.height; ++i) {
    const Window rows = WindowOf(i, from.height, to.height);
    for (int j = 0; j < to.width; ++j) {
      const Window columns = WindowOf(j, from.width, to.width);
      const float share =
          1.f / static_cast<float>((rows.end - rows.begin) * (columns.end - columns.begin));
      for (int u = rows.begin; u < rows.end; ++u) {
        for (int v = columns.begin; v < columns.end; ++v) {
          visit(i * to.width + j, u * from.width + v, share);
        }
      }
    }
  }
}

void Load(const float* in, int n, float* out) { std::copy_n(in, n, out); }
void Load(const uint16_t* in, int n, float* out) { Bf16ToFloats(in, n, out); }
void Save(const float* in, int n, float* out) { std::copy_n(in, n, out); }
void Save(const float* in, int n, uint16_t* out) { FloatsToBf16(in, n, out); }

// Maps plane by plane through f32: in (planes, n_in) -> out (planes, n_out). add(plane in, plane
// out) adds to zeros.
template <class T, class AddPlane>
void MapPlanes(int planes, const memory& in, int n_in, const memory& out, int n_out,
               const AddPlane& add) {
  const auto* from = static_cast<const T*>(in.get_data_handle());
  auto* to = static_cast<T*>(out.get_data_handle());
  ParallelFor(planes, [&](int begin, int end) {
    std::vector<float> plane_in(static_cast<size_t>(n_in)), plane_out(static_cast<size_t>(n_out));
    for (int p = begin; p < end; ++p) {
      Load(from + int64_t{p} * n_in, n_in, plane_in.data());
      std::fill(plane_out.begin(), plane_out.end(), 0.f);
      add(plane_in.data(), plane_out.data());
      Save(plane_out.data(), n_out, to + int64_t{p} * n_out);
    }
  });
}

template <class AddPlane>
void MapPlanes(int planes, const memory& in, int n_in, const memory& out, int n_out,
               const AddPlane& add) {
  if (TypeOf(in) == memory::data_type::bf16) {
    MapPlanes<uint16_t>(planes, in, n_in, out, n_out, add);
  } else {
    MapPlanes<float>(planes, in, n_in, out, n_out, add);
  }
}

}  // namespace

AveragePool::AveragePool(const LayerContext& context, const LayerPlan& plan, const memory& source,
                         const memory& source_gradient)
    : planes_(context.batch * plan.input.channels), from_(plan.input), to_(plan.output) {
  const auto row_major = [&](const MapShape& map) {
    return memory::desc({context.batch, map.channels, map.height, map.width}, TypeOf(source),
                        memory::format_tag::nchw);
  };
  source_ = Relayout::Before(source, row_major(from_), context.scratchpad);
  output_ = MakeMemory(row_major(to_));
  if (!context.training) return;
  output_gradient_ = MakeMemory(row_major(to_));
  has_source_gradient_ = static_cast<bool>(source_gradient);
  if (!has_source_gradient_) return;
  source_gradient_ = Relayout::After(row_major(from_), source_gradient, context.scratchpad);
}

void AveragePool::Forward(Statistics) {
  source_.Run();
  MapPlanes(planes_, source_.memory(), from_.height * from_.width, output_, to_.height * to_.width,
            [&](const float* x, float* y) {
              ForPairs(from_, to_,
                       [&](int at, int from, float share) { y[at] += share * x[from]; });
            });
}

void AveragePool::Backward() {
  if (!has_source_gradient_) return;
  MapPlanes(planes_, output_gradient_, to_.height * to_.width, source_gradient_.memory(),
            from_.height * from_.width, [&](const float* dy, float* dx) {
              ForPairs(from_, to_,
                       [&](int at, int from, float share) { dx[from] += share * dy[at]; });
            });
  source_gradient_.Run();
}

}  // namespace shoal::nn
