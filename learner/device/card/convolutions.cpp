// SPDX-License-Identifier: Apache-2.0
#include "learner/device/card/convolutions.h"

#include <cstddef>

#include "learner/device/card/cuda_error.h"
#include "learner/device/card/launches.h"

namespace shoal::learner::device {
namespace {

constexpr int64_t kAlignment = 256;  // of the parts of a workspace, in bytes

int64_t Aligned(int64_t bytes) { return kernels::CeilDivide(bytes, kAlignment) * kAlignment; }

kernels::MapShape KernelShape(const ConvolutionShape& s) {
  return {.batch = s.batch,
          .height = s.height,
          .width = s.width,
          .channels = s.channels,
          .filters = s.filters,
          .kernel = s.kernel,
          .stride = s.stride,
          .padding = s.padding,
          .output_height = s.output_height,
          .output_width = s.output_width};
}

kernels::Source Read(Type type, const void* memory) {
  return type == Type::kBf16 ? kernels::Source{.bf16 = static_cast<const uint16_t*>(memory)}
                             : kernels::Source{.f32 = static_cast<const float*>(memory)};
}
kernels::InPlace Write(Type type, void* memory) {
  return type == Type::kBf16 ? kernels::InPlace{.bf16 = static_cast<uint16_t*>(memory)}
                             : kernels::InPlace{.f32 = static_cast<float*>(memory)};
}

// The shapes for which our kernels are faster than cuDNN's engines with a fixed order of sums
// (docs/notes/learner-on-a-gpu.md).
bool ByForwardTiles(const ConvolutionShape& shape) {
  constexpr int32_t kMostChannels = 32, kMostFilters = 64, kLargestKernel = 8;
  return shape.type == Type::kBf16 && shape.channels <= kMostChannels &&
         shape.filters <= kMostFilters && shape.kernel <= kLargestKernel &&
         kernels::ConvolveForwardByTiles::StripsOf(KernelShape(shape)).rows > 0;
}
bool ByWeightTiles(const ConvolutionShape& shape) {
  constexpr int kMostGroups = 8;
  using Tiles = kernels::ConvolveWeightsByTiles;
  return shape.type == Type::kBf16 && Tiles::GroupsOf(KernelShape(shape)) <= kMostGroups &&
         Tiles::StripsOf(KernelShape(shape)).rows > 0;
}

void* After(void* memory, int64_t bytes) { return static_cast<std::byte*>(memory) + bytes; }

// Sums of a bias's gradient over the pixels of dy.
kernels::ActivationBackward BiasGradient(const ConvolutionWeights& command) {
  return {.sums = {.rows = KernelShape(command.shape).pixels(), .columns = command.shape.filters},
          .dy = Read(command.shape.type, command.dy),
          .dbias = command.bias_gradient};
}

kernels::ConvolveWeightsByTiles ByTiles(const ConvolutionWeights& command) {
  return {.strips = kernels::ConvolveWeightsByTiles::StripsOf(KernelShape(command.shape)),
          .x = static_cast<const uint16_t*>(command.x),
          .dy = static_cast<const uint16_t*>(command.dy),
          .weight_gradient = command.weight_gradient,
          .bias_gradient = command.bias_gradient,
          .partials = nullptr};
}

}  // namespace

int64_t CudaConvolutions::Prepare(const ConvolutionForward& command) {
  if (ByForwardTiles(command.shape)) return 0;
  const CudnnPlan* plan = plans_.Of(ConvolutionKind::kForward, command.shape);
  return plan == nullptr ? 0 : plan->workspace_bytes;
}

int64_t CudaConvolutions::Prepare(const ConvolutionData& command) {
  const CudnnPlan* plan = plans_.Of(ConvolutionKind::kData, command.shape);
  return plan == nullptr ? 0 : plan->workspace_bytes;
}

CudaConvolutions::WeightsWorkspace CudaConvolutions::WorkspaceOf(
    const ConvolutionWeights& command) {
  WeightsWorkspace parts;
  if (ByWeightTiles(command.shape)) {
    parts.sums = ByTiles(command).PartialsSize() * int64_t{sizeof(float)};
    return parts;
  }
  const CudnnPlan* plan = plans_.Of(ConvolutionKind::kWeights, command.shape);
  if (plan == nullptr) return parts;
  parts.plan = Aligned(plan->workspace_bytes);
  if (plan->narrow) {
    parts.narrow = Aligned(KernelShape(command.shape).weights() * int64_t{sizeof(uint16_t)});
  }
  if (command.bias_gradient != nullptr) {
    const kernels::ColumnSums sums = BiasGradient(command).sums;
    parts.sums = Aligned(sums.PartialsSize() * int64_t{sizeof(float)});
    parts.counters = Aligned(sums.groups() * int64_t{sizeof(int32_t)});
  }
  return parts;
}

int64_t CudaConvolutions::Prepare(const ConvolutionWeights& command) {
  return WorkspaceOf(command).total();
}

void CudaConvolutions::Run(const ConvolutionForward& command, void* workspace) {
  const ConvolutionShape& s = command.shape;
  if (ByForwardTiles(s)) {
    Launch(kernels::ConvolveForwardByTiles{.strips = kernels::ConvolveForwardByTiles::StripsOf(
                                               KernelShape(s)),
                                           .x = static_cast<const uint16_t*>(command.x),
                                           .weight = static_cast<const uint16_t*>(command.weight),
                                           .bias = command.bias,
                                           .relu = command.relu ? 1 : 0,
                                           .y = static_cast<uint16_t*>(command.y)},
           stream_);
    return;
  }
  const CudnnPlan* plan = plans_.Of(ConvolutionKind::kForward, s);
  if (plan == nullptr) {
    Launch(kernels::ConvolveForward{.shape = KernelShape(s),
                                    .x = Read(s.type, command.x),
                                    .weight = Read(s.type, command.weight),
                                    .bias = command.bias,
                                    .relu = command.relu ? 1 : 0,
                                    .y = Write(s.type, command.y)},
           stream_);
    return;
  }
  plans_.Run(*plan, command.x, command.weight, command.y, workspace);
  if (command.bias == nullptr && !command.relu) return;
  Launch(kernels::AddBiasToMap{.y = static_cast<uint16_t*>(command.y),
                               .bias = command.bias,
                               .relu = command.relu ? 1 : 0,
                               .filters = s.filters,
                               .size = KernelShape(s).outputs()},
         stream_);
}

void CudaConvolutions::Run(const ConvolutionData& command, void* workspace) {
  const ConvolutionShape& s = command.shape;
  const CudnnPlan* plan = plans_.Of(ConvolutionKind::kData, s);
  if (plan == nullptr) {
    Launch(kernels::ConvolveData{.shape = KernelShape(s),
                                 .dy = Read(s.type, command.dy),
                                 .weight = Read(s.type, command.weight),
                                 .dx = Write(s.type, command.dx)},
           stream_);
    return;
  }
  plans_.Run(*plan, command.dx, command.weight, command.dy, workspace);
}

void CudaConvolutions::Run(const ConvolutionWeights& command, void* workspace) {
  const ConvolutionShape& s = command.shape;
  if (ByWeightTiles(s)) {
    RunByTiles(command, workspace);
  } else if (const CudnnPlan* plan = plans_.Of(ConvolutionKind::kWeights, s)) {
    RunPlan(*plan, command, workspace);
  } else {
    Launch(kernels::ConvolveWeights{.shape = KernelShape(s),
                                    .x = Read(s.type, command.x),
                                    .dy = Read(s.type, command.dy),
                                    .weight_gradient = command.weight_gradient,
                                    .bias_gradient = command.bias_gradient},
           stream_);
  }
}

void CudaConvolutions::RunByTiles(const ConvolutionWeights& command, void* workspace) {
  kernels::ConvolveWeightsByTiles tiles = ByTiles(command);
  tiles.partials = static_cast<float*>(workspace);
  Launch(tiles, stream_);
  if (tiles.parts() == 1) return;
  Launch(kernels::AddWeightParts{.partials = tiles.partials,
                                 .parts = tiles.parts(),
                                 .weights = tiles.shape().weights(),
                                 .biases = tiles.shape().filters,
                                 .weight_gradient = command.weight_gradient,
                                 .bias_gradient = command.bias_gradient},
         stream_);
}

void CudaConvolutions::RunPlan(const CudnnPlan& plan, const ConvolutionWeights& command,
                               void* workspace) {
  const WeightsWorkspace parts = WorkspaceOf(command);
  if (plan.narrow) {
    auto* narrow = static_cast<uint16_t*>(After(workspace, parts.plan));
    plans_.Run(plan, command.x, narrow, command.dy, workspace);
    Launch(kernels::WidenToF32{.from = narrow,
                               .to = command.weight_gradient,
                               .size = KernelShape(command.shape).weights()},
           stream_);
  } else {
    plans_.Run(plan, command.x, command.weight_gradient, command.dy, workspace);
  }
  if (command.bias_gradient == nullptr) return;
  kernels::ActivationBackward bias = BiasGradient(command);
  void* const sums = After(workspace, parts.plan + parts.narrow);
  void* const counters = After(sums, parts.sums);
  bias.sums.partials = static_cast<float*>(sums);
  bias.sums.finished = static_cast<int32_t*>(counters);
  Require(cudaMemsetAsync(counters, 0, static_cast<size_t>(parts.counters), stream_),
          "clearing memory");
  Launch(bias, stream_);
}

}  // namespace shoal::learner::device
