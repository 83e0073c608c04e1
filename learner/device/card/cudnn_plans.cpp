// SPDX-License-Identifier: Apache-2.0
#include "learner/device/card/cudnn_plans.h"

#include <cstdio>
#include <optional>
#include <vector>

#include "learner/device/card/cuda_error.h"

namespace shoal::learner::device {
namespace {

constexpr char kWhat[] = "preparing a convolution";
constexpr int64_t kInput = 'x', kWeight = 'w', kOutput = 'y';  // names of cuDNN's tensors

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

}  // namespace

CudnnPlans::CudnnPlans(cudaStream_t stream) {
  Require(cudnnCreate(&handle_), "opening cuDNN");
  Require(cudnnSetStream(handle_, stream), "opening cuDNN");
}

CudnnPlans::~CudnnPlans() {
  plans_.clear();
  cudnnDestroy(handle_);
}

std::unique_ptr<CudnnPlan> CudnnPlans::Choose(ConvolutionKind kind,
                                              const ConvolutionShape& shape) const {
  const OperationNames& names = kind == ConvolutionKind::kForward ? kForwardNames
                                : kind == ConvolutionKind::kData  ? kDataNames
                                                                  : kWeightsNames;
  // A gradient of the weights in f32 if possible, so that it is not rounded.
  const std::vector<cudnnDataType_t> types =
      kind == ConvolutionKind::kWeights ? std::vector{CUDNN_DATA_FLOAT, CUDNN_DATA_BFLOAT16}
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
        const bool narrow = kind == ConvolutionKind::kWeights && type == CUDNN_DATA_BFLOAT16;
        return std::make_unique<CudnnPlan>(CudnnPlan{bytes, narrow, std::move(plan)});
      }
    }
  }
  return nullptr;
}

const CudnnPlan* CudnnPlans::Of(ConvolutionKind kind, const ConvolutionShape& s) {
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

void CudnnPlans::Run(const CudnnPlan& plan, const void* input, const void* weight,
                     const void* output, void* workspace) const {
  Descriptor pack(CUDNN_BACKEND_VARIANT_PACK_DESCRIPTOR);
  pack.Set(CUDNN_ATTR_VARIANT_PACK_UNIQUE_IDS, {kInput, kWeight, kOutput});
  pack.Set<const void*>(CUDNN_ATTR_VARIANT_PACK_DATA_POINTERS, CUDNN_TYPE_VOID_PTR,
                        {input, weight, output});
  pack.Set<const void*>(CUDNN_ATTR_VARIANT_PACK_WORKSPACE, CUDNN_TYPE_VOID_PTR, {workspace});
  pack.Finalize();
  Require(cudnnBackendExecute(handle_, plan.plan.get(), pack.get()), "computing a convolution");
}

}  // namespace shoal::learner::device
