// SPDX-License-Identifier: Apache-2.0
#include "learner/device/card/convolutions.h"

#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "learner/device/card/cuda_error.h"
#include "learner/device/card/launches.h"
#include "learner/device/card/weight_kernels.h"

namespace shoal::learner::device {
namespace {

constexpr char kWhat[] = "preparing a convolution";
constexpr int64_t kInput = 'x', kWeight = 'w', kOutput = 'y';  // names of cuDNN's tensors
constexpr int64_t kAlignment = 256;                            // of workspaces, in bytes

int64_t Aligned(int64_t bytes) { return kernels::CeilDivide(bytes, kAlignment) * kAlignment; }

// A descriptor of cuDNN's graph interface.
class Descriptor {
 public:
  explicit Descriptor(cudnnBackendDescriptorType_t type) {
    Require(cudnnBackendCreateDescriptor(type, &descriptor_), kWhat);
  }
  ~Descriptor() {
    if (descriptor_ != nullptr) cudnnBackendDestroyDescriptor(descriptor_);
  }
  Descriptor(Descriptor&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, nullptr)) {}
  Descriptor& operator=(Descriptor&&) = delete;

  cudnnBackendDescriptor_t get() const { return descriptor_; }

  template <class T>
  void Set(cudnnBackendAttributeName_t name, cudnnBackendAttributeType_t type,
           const std::vector<T>& values) {
    Require(cudnnBackendSetAttribute(descriptor_, name, type, static_cast<int64_t>(values.size()),
                                     values.data()),
            kWhat);
  }
  void Set(cudnnBackendAttributeName_t name, const std::vector<int64_t>& values) {
    Set(name, CUDNN_TYPE_INT64, values);
  }
  void Set(cudnnBackendAttributeName_t name, const Descriptor& other) {
    const cudnnBackendDescriptor_t value = other.get();
    Require(cudnnBackendSetAttribute(descriptor_, name, CUDNN_TYPE_BACKEND_DESCRIPTOR, 1, &value),
            kWhat);
  }
  void Finalize() { Require(TryFinalize(), kWhat); }
  cudnnStatus_t TryFinalize() { return cudnnBackendFinalize(descriptor_); }

 private:
  cudnnBackendDescriptor_t descriptor_ = nullptr;
};

// A tensor with dimensions (N, C, H, W) whose channels are adjacent in memory.
Descriptor TensorOf(int64_t name, cudnnDataType_t type, int64_t n, int64_t c, int64_t h,
                    int64_t w) {
  Descriptor tensor(CUDNN_BACKEND_TENSOR_DESCRIPTOR);
  tensor.Set(CUDNN_ATTR_TENSOR_UNIQUE_ID, {name});
  tensor.Set<cudnnDataType_t>(CUDNN_ATTR_TENSOR_DATA_TYPE, CUDNN_TYPE_DATA_TYPE, {type});
  tensor.Set(CUDNN_ATTR_TENSOR_DIMENSIONS, {n, c, h, w});
  tensor.Set(CUDNN_ATTR_TENSOR_STRIDES, {h * w * c, 1, w * c, c});
  tensor.Set(CUDNN_ATTR_TENSOR_BYTE_ALIGNMENT, {16});
  tensor.Finalize();
  return tensor;
}

Descriptor ConvolutionOf(const ConvolutionShape& shape) {
  Descriptor convolution(CUDNN_BACKEND_CONVOLUTION_DESCRIPTOR);
  const int64_t stride = shape.stride, padding = shape.padding;
  convolution.Set<cudnnDataType_t>(CUDNN_ATTR_CONVOLUTION_COMP_TYPE, CUDNN_TYPE_DATA_TYPE,
                                   {CUDNN_DATA_FLOAT});
  convolution.Set<cudnnConvolutionMode_t>(CUDNN_ATTR_CONVOLUTION_CONV_MODE,
                                          CUDNN_TYPE_CONVOLUTION_MODE, {CUDNN_CROSS_CORRELATION});
  convolution.Set(CUDNN_ATTR_CONVOLUTION_SPATIAL_DIMS, {2});
  convolution.Set(CUDNN_ATTR_CONVOLUTION_DILATIONS, {1, 1});
  convolution.Set(CUDNN_ATTR_CONVOLUTION_FILTER_STRIDES, {stride, stride});
  convolution.Set(CUDNN_ATTR_CONVOLUTION_PRE_PADDINGS, {padding, padding});
  convolution.Set(CUDNN_ATTR_CONVOLUTION_POST_PADDINGS, {padding, padding});
  convolution.Finalize();
  return convolution;
}

// Attributes of the operation that computes a convolution or one of its gradients.
struct OperationNames {
  cudnnBackendDescriptorType_t type;
  cudnnBackendAttributeName_t convolution, input, weight, output, alpha, beta;
};
constexpr OperationNames kForwardNames{CUDNN_BACKEND_OPERATION_CONVOLUTION_FORWARD_DESCRIPTOR,
                                       CUDNN_ATTR_OPERATION_CONVOLUTION_FORWARD_CONV_DESC,
                                       CUDNN_ATTR_OPERATION_CONVOLUTION_FORWARD_X,
                                       CUDNN_ATTR_OPERATION_CONVOLUTION_FORWARD_W,
                                       CUDNN_ATTR_OPERATION_CONVOLUTION_FORWARD_Y,
                                       CUDNN_ATTR_OPERATION_CONVOLUTION_FORWARD_ALPHA,
                                       CUDNN_ATTR_OPERATION_CONVOLUTION_FORWARD_BETA};
constexpr OperationNames kDataNames{CUDNN_BACKEND_OPERATION_CONVOLUTION_BACKWARD_DATA_DESCRIPTOR,
                                    CUDNN_ATTR_OPERATION_CONVOLUTION_BWD_DATA_CONV_DESC,
                                    CUDNN_ATTR_OPERATION_CONVOLUTION_BWD_DATA_DX,
                                    CUDNN_ATTR_OPERATION_CONVOLUTION_BWD_DATA_W,
                                    CUDNN_ATTR_OPERATION_CONVOLUTION_BWD_DATA_DY,
                                    CUDNN_ATTR_OPERATION_CONVOLUTION_BWD_DATA_ALPHA,
                                    CUDNN_ATTR_OPERATION_CONVOLUTION_BWD_DATA_BETA};
constexpr OperationNames kWeightsNames{
    CUDNN_BACKEND_OPERATION_CONVOLUTION_BACKWARD_FILTER_DESCRIPTOR,
    CUDNN_ATTR_OPERATION_CONVOLUTION_BWD_FILTER_CONV_DESC,
    CUDNN_ATTR_OPERATION_CONVOLUTION_BWD_FILTER_X,
    CUDNN_ATTR_OPERATION_CONVOLUTION_BWD_FILTER_DW,
    CUDNN_ATTR_OPERATION_CONVOLUTION_BWD_FILTER_DY,
    CUDNN_ATTR_OPERATION_CONVOLUTION_BWD_FILTER_ALPHA,
    CUDNN_ATTR_OPERATION_CONVOLUTION_BWD_FILTER_BETA};

// The graph of one operation.
struct OneOperation {
  Descriptor input, weight, output, convolution, operation, graph;
};

OneOperation GraphOf(const OperationNames& names, const ConvolutionShape& s,
                     cudnnDataType_t weight_type, cudnnHandle_t handle) {
  OneOperation one{
      .input = TensorOf(kInput, CUDNN_DATA_BFLOAT16, s.batch, s.channels, s.height, s.width),
      .weight = TensorOf(kWeight, weight_type, s.filters, s.channels, s.kernel, s.kernel),
      .output = TensorOf(kOutput, CUDNN_DATA_BFLOAT16, s.batch, s.filters, s.output_height,
                         s.output_width),
      .convolution = ConvolutionOf(s),
      .operation = Descriptor(names.type),
      .graph = Descriptor(CUDNN_BACKEND_OPERATIONGRAPH_DESCRIPTOR)};
  one.operation.Set(names.convolution, one.convolution);
  one.operation.Set(names.input, one.input);
  one.operation.Set(names.weight, one.weight);
  one.operation.Set(names.output, one.output);
  one.operation.Set<float>(names.alpha, CUDNN_TYPE_FLOAT, {1.0F});
  one.operation.Set<float>(names.beta, CUDNN_TYPE_FLOAT, {0.0F});
  one.operation.Finalize();
  one.graph.Set<cudnnHandle_t>(CUDNN_ATTR_OPERATIONGRAPH_HANDLE, CUDNN_TYPE_HANDLE, {handle});
  one.graph.Set(CUDNN_ATTR_OPERATIONGRAPH_OPS, one.operation);
  one.graph.Finalize();
  return one;
}

// Configurations of engines for the graph, the fastest first as cuDNN expects.
std::vector<Descriptor> ConfigurationsOf(const OneOperation& one, cudnnBackendHeurMode_t mode) {
  constexpr int64_t kMost = 16;
  std::vector<Descriptor> configurations;
  Descriptor heuristics(CUDNN_BACKEND_ENGINEHEUR_DESCRIPTOR);
  heuristics.Set(CUDNN_ATTR_ENGINEHEUR_OPERATION_GRAPH, one.graph);
  heuristics.Set<cudnnBackendHeurMode_t>(CUDNN_ATTR_ENGINEHEUR_MODE, CUDNN_TYPE_HEUR_MODE, {mode});
  if (heuristics.TryFinalize() != CUDNN_STATUS_SUCCESS) return configurations;
  std::vector<cudnnBackendDescriptor_t> found;
  for (int64_t i = 0; i < kMost; ++i) {
    found.push_back(configurations.emplace_back(CUDNN_BACKEND_ENGINECFG_DESCRIPTOR).get());
  }
  int64_t count = 0;
  Require(cudnnBackendGetAttribute(heuristics.get(), CUDNN_ATTR_ENGINEHEUR_RESULTS,
                                   CUDNN_TYPE_BACKEND_DESCRIPTOR, kMost, &count, found.data()),
          kWhat);
  while (static_cast<int64_t>(configurations.size()) > count) configurations.pop_back();
  return configurations;
}

// Whether the engine adds in a fixed order.
bool IsDeterministic(const Descriptor& configuration) {
  Descriptor engine(CUDNN_BACKEND_ENGINE_DESCRIPTOR);
  cudnnBackendDescriptor_t value = engine.get();
  int64_t count = 0;
  Require(cudnnBackendGetAttribute(configuration.get(), CUDNN_ATTR_ENGINECFG_ENGINE,
                                   CUDNN_TYPE_BACKEND_DESCRIPTOR, 1, &count, &value),
          kWhat);
  std::vector<cudnnBackendNumericalNote_t> notes(CUDNN_NUMERICAL_NOTE_TYPE_COUNT);
  Require(cudnnBackendGetAttribute(engine.get(), CUDNN_ATTR_ENGINE_NUMERICAL_NOTE,
                                   CUDNN_TYPE_NUMERICAL_NOTE, CUDNN_NUMERICAL_NOTE_TYPE_COUNT,
                                   &count, notes.data()),
          kWhat);
  notes.resize(static_cast<size_t>(count));
  for (const cudnnBackendNumericalNote_t note : notes) {
    if (note == CUDNN_NUMERICAL_NOTE_NONDETERMINISTIC) return false;
  }
  return true;
}

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

class CudaConvolutions::Plan {
 public:
  Plan(Descriptor plan, int64_t bytes, bool is_narrow)
      : workspace_bytes(bytes), narrow(is_narrow), plan_(std::move(plan)) {}

  void Run(cudnnHandle_t handle, const void* input, const void* weight, const void* output,
           void* workspace) const {
    Descriptor pack(CUDNN_BACKEND_VARIANT_PACK_DESCRIPTOR);
    pack.Set(CUDNN_ATTR_VARIANT_PACK_UNIQUE_IDS, {kInput, kWeight, kOutput});
    pack.Set<const void*>(CUDNN_ATTR_VARIANT_PACK_DATA_POINTERS, CUDNN_TYPE_VOID_PTR,
                          {input, weight, output});
    pack.Set<const void*>(CUDNN_ATTR_VARIANT_PACK_WORKSPACE, CUDNN_TYPE_VOID_PTR, {workspace});
    pack.Finalize();
    Require(cudnnBackendExecute(handle, plan_.get(), pack.get()), "computing a convolution");
  }

  const int64_t workspace_bytes;
  const bool narrow;  // the gradient of the weights is bf16

 private:
  Descriptor plan_;
};

CudaConvolutions::CudaConvolutions(cudaStream_t stream) : stream_(stream) {
  Require(cudnnCreate(&handle_), "opening cuDNN");
  Require(cudnnSetStream(handle_, stream), "opening cuDNN");
}

CudaConvolutions::~CudaConvolutions() {
  plans_.clear();
  cudnnDestroy(handle_);
}

std::unique_ptr<CudaConvolutions::Plan> CudaConvolutions::Choose(
    Kind kind, const ConvolutionShape& shape) const {
  const OperationNames& names = kind == Kind::kForward ? kForwardNames
                                : kind == Kind::kData  ? kDataNames
                                                       : kWeightsNames;
  // A gradient of the weights in f32 if possible, so that it is not rounded.
  const std::vector<cudnnDataType_t> types =
      kind == Kind::kWeights ? std::vector{CUDNN_DATA_FLOAT, CUDNN_DATA_BFLOAT16}
                             : std::vector{CUDNN_DATA_BFLOAT16};
  for (const cudnnDataType_t type : types) {
    std::optional<OneOperation> one;
    try {
      one.emplace(GraphOf(names, shape, type, handle_));
    } catch (const Error&) {  // cuDNN does not know the combination of types
      continue;
    }
    for (const auto mode : {CUDNN_HEUR_MODE_A, CUDNN_HEUR_MODE_FALLBACK}) {
      for (const Descriptor& configuration : ConfigurationsOf(*one, mode)) {
        if (!IsDeterministic(configuration)) continue;
        Descriptor plan(CUDNN_BACKEND_EXECUTION_PLAN_DESCRIPTOR);
        plan.Set<cudnnHandle_t>(CUDNN_ATTR_EXECUTION_PLAN_HANDLE, CUDNN_TYPE_HANDLE, {handle_});
        plan.Set(CUDNN_ATTR_EXECUTION_PLAN_ENGINE_CONFIG, configuration);
        if (plan.TryFinalize() != CUDNN_STATUS_SUCCESS) continue;
        int64_t bytes = 0, count = 0;
        Require(cudnnBackendGetAttribute(plan.get(), CUDNN_ATTR_EXECUTION_PLAN_WORKSPACE_SIZE,
                                         CUDNN_TYPE_INT64, 1, &count, &bytes),
                kWhat);
        return std::make_unique<Plan>(std::move(plan), bytes,
                                      kind == Kind::kWeights && type == CUDNN_DATA_BFLOAT16);
      }
    }
  }
  return nullptr;
}

CudaConvolutions::Plan* CudaConvolutions::PlanOf(Kind kind, const ConvolutionShape& s) {
  if (s.type == Type::kF32) return nullptr;
  const Key key{static_cast<int32_t>(kind),
                s.batch,
                s.height,
                s.width,
                s.channels,
                s.filters,
                s.kernel,
                s.stride,
                s.padding,
                s.output_height,
                s.output_width};
  const auto [place, fresh] = plans_.try_emplace(key);
  if (!fresh) return place->second.get();
  place->second = Choose(kind, s);
  if (place->second == nullptr) {
    constexpr const char* kNames[] = {"convolution", "gradient by the input",
                                      "gradient by the weights"};
    std::fprintf(stderr,
                 "cuDNN has no engine for the %s of (%d, %d, %d, %d) with %d filters of %d x %d, "
                 "stride %d: a slower kernel computes it\n",
                 kNames[static_cast<int>(kind)], s.batch, s.height, s.width, s.channels, s.filters,
                 s.kernel, s.kernel, s.stride);
  }
  return place->second.get();
}

int64_t CudaConvolutions::Prepare(const ConvolutionForward& command) {
  if (ByForwardTiles(command.shape)) return 0;
  const Plan* plan = PlanOf(Kind::kForward, command.shape);
  return plan == nullptr ? 0 : plan->workspace_bytes;
}

int64_t CudaConvolutions::Prepare(const ConvolutionData& command) {
  const Plan* plan = PlanOf(Kind::kData, command.shape);
  return plan == nullptr ? 0 : plan->workspace_bytes;
}

CudaConvolutions::WeightsWorkspace CudaConvolutions::WorkspaceOf(
    const ConvolutionWeights& command) {
  WeightsWorkspace parts;
  if (ByWeightTiles(command.shape)) {
    parts.sums = ByTiles(command).PartialsSize() * int64_t{sizeof(float)};
    return parts;
  }
  const Plan* plan = PlanOf(Kind::kWeights, command.shape);
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
  const Plan* plan = PlanOf(Kind::kForward, s);
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
  plan->Run(handle_, command.x, command.weight, command.y, workspace);
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
  const Plan* plan = PlanOf(Kind::kData, s);
  if (plan == nullptr) {
    Launch(kernels::ConvolveData{.shape = KernelShape(s),
                                 .dy = Read(s.type, command.dy),
                                 .weight = Read(s.type, command.weight),
                                 .dx = Write(s.type, command.dx)},
           stream_);
    return;
  }
  plan->Run(handle_, command.dx, command.weight, command.dy, workspace);
}

void CudaConvolutions::Run(const ConvolutionWeights& command, void* workspace) {
  const ConvolutionShape& s = command.shape;
  if (ByWeightTiles(s)) {
    RunByTiles(command, workspace);
  } else if (const Plan* plan = PlanOf(Kind::kWeights, s)) {
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

void CudaConvolutions::RunPlan(const Plan& plan, const ConvolutionWeights& command,
                               void* workspace) {
  const WeightsWorkspace parts = WorkspaceOf(command);
  if (plan.narrow) {
    auto* narrow = static_cast<uint16_t*>(After(workspace, parts.plan));
    plan.Run(handle_, command.x, narrow, command.dy, workspace);
    Launch(kernels::WidenToF32{.from = narrow,
                               .to = command.weight_gradient,
                               .size = KernelShape(command.shape).weights()},
           stream_);
  } else {
    plan.Run(handle_, command.x, command.weight_gradient, command.dy, workspace);
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
