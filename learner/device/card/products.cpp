// SPDX-License-Identifier: Apache-2.0
#include "learner/device/card/products.h"

#include <algorithm>

#include "learner/device/card/cuda_error.h"
#include "learner/device/card/launches.h"

namespace shoal::learner::device {
namespace {

constexpr char kWhat[] = "preparing a product";

cudaDataType_t DataType(Type type) { return type == Type::kBf16 ? CUDA_R_16BF : CUDA_R_32F; }
int64_t Bytes(Type type) { return type == Type::kBf16 ? 2 : 4; }

// Largest power of two up to 256 that divides the address of every product of a batch.
int64_t Alignment(const void* address, int64_t step_bytes) {
  const uint64_t bits =
      reinterpret_cast<uintptr_t>(address) | static_cast<uint64_t>(step_bytes) | uint64_t{256};
  return static_cast<int64_t>(bits & (~bits + 1));
}

int64_t AlignmentOfA(const Product& p) { return Alignment(p.a, p.a_step * Bytes(p.input)); }
int64_t AlignmentOfB(const Product& p) { return Alignment(p.b, p.b_step * Bytes(p.input)); }
int64_t AlignmentOfD(const Product& p) { return Alignment(p.d, p.d_step * Bytes(p.output)); }

template <class T>
void Set(cublasLtMatmulDesc_t description, cublasLtMatmulDescAttributes_t attribute, T value) {
  Require(cublasLtMatmulDescSetAttribute(description, attribute, &value, sizeof(value)), kWhat);
}
template <class T>
void Set(cublasLtMatmulPreference_t preference, cublasLtMatmulPreferenceAttributes_t attribute,
         T value) {
  Require(cublasLtMatmulPreferenceSetAttribute(preference, attribute, &value, sizeof(value)),
          kWhat);
}

// Layout of a row-major matrix, which for cuBLASLt is a matrix of `fast` rows.
cublasLtMatrixLayout_t NewLayout(Type type, int64_t fast, int64_t slow, int64_t stride,
                                 int32_t count, int64_t step) {
  cublasLtMatrixLayout_t layout = nullptr;
  Require(cublasLtMatrixLayoutCreate(&layout, DataType(type), static_cast<uint64_t>(fast),
                                     static_cast<uint64_t>(slow), stride),
          kWhat);
  Require(cublasLtMatrixLayoutSetAttribute(layout, CUBLASLT_MATRIX_LAYOUT_BATCH_COUNT, &count,
                                           sizeof(count)),
          kWhat);
  Require(cublasLtMatrixLayoutSetAttribute(layout, CUBLASLT_MATRIX_LAYOUT_STRIDED_BATCH_OFFSET,
                                           &step, sizeof(step)),
          kWhat);
  return layout;
}

cublasLtEpilogue_t EpilogueOf(const Product& product) {
  if (product.bias != nullptr) {
    return product.relu ? CUBLASLT_EPILOGUE_RELU_BIAS : CUBLASLT_EPILOGUE_BIAS;
  }
  return product.relu ? CUBLASLT_EPILOGUE_RELU : CUBLASLT_EPILOGUE_DEFAULT;
}

kernels::AddBias AfterProduct(const Product& product) {
  kernels::AddBias after{.y = {},
                         .bias = product.bias,
                         .relu = product.relu ? 1 : 0,
                         .rows = product.rows,
                         .columns = product.columns,
                         .stride = product.d_stride,
                         .count = product.count,
                         .step = product.d_step,
                         .bias_step = product.bias_step};
  if (product.output == Type::kBf16) {
    after.y.bf16 = static_cast<uint16_t*>(product.d);
  } else {
    after.y.f32 = static_cast<float*>(product.d);
  }
  return after;
}

}  // namespace

// cuBLASLt's matrices are column-major, so it computes the transposed product
// D^T (columns, rows) = op(B)^T op(A)^T: its first operand is B. Its bias belongs to its rows.
struct CudaProducts::Plan {
  cublasLtMatmulDesc_t description = nullptr;
  cublasLtMatrixLayout_t first = nullptr, second = nullptr, result = nullptr;
  cublasLtMatmulAlgo_t algorithm{};
  bool fused = true;  // bias and ReLU are part of the product

  Plan() = default;
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
  ~Plan() {
    if (description != nullptr) cublasLtMatmulDescDestroy(description);
    for (cublasLtMatrixLayout_t layout : {first, second, result}) {
      if (layout != nullptr) cublasLtMatrixLayoutDestroy(layout);
    }
  }
};

CudaProducts::CudaProducts() { Require(cublasLtCreate(&handle_), "opening cuBLASLt"); }

CudaProducts::~CudaProducts() {
  plans_.clear();
  cublasLtDestroy(handle_);
}

CudaProducts::Key CudaProducts::KeyOf(const Product& p) {
  return {p.rows,
          p.columns,
          p.depth,
          static_cast<int64_t>(p.input),
          static_cast<int64_t>(p.output),
          p.a_stride,
          p.b_stride,
          p.d_stride,
          p.a_transposed,
          p.b_transposed,
          p.bias != nullptr,
          p.relu,
          p.count,
          p.a_step,
          p.b_step,
          p.d_step,
          p.bias_step,
          AlignmentOfA(p),
          AlignmentOfB(p),
          AlignmentOfD(p)};
}

std::unique_ptr<CudaProducts::Plan> CudaProducts::Choose(const Product& p, bool fused) const {
  auto plan = std::make_unique<Plan>();
  plan->fused = fused;
  // f32: CUBLAS_COMPUTE_32F uses no TF32.
  Require(cublasLtMatmulDescCreate(&plan->description, CUBLAS_COMPUTE_32F, CUDA_R_32F), kWhat);
  Set(plan->description, CUBLASLT_MATMUL_DESC_TRANSA, p.b_transposed ? CUBLAS_OP_T : CUBLAS_OP_N);
  Set(plan->description, CUBLASLT_MATMUL_DESC_TRANSB, p.a_transposed ? CUBLAS_OP_T : CUBLAS_OP_N);
  if (fused) {
    Set(plan->description, CUBLASLT_MATMUL_DESC_EPILOGUE, EpilogueOf(p));
    if (p.bias != nullptr) {
      Set(plan->description, CUBLASLT_MATMUL_DESC_BIAS_DATA_TYPE, CUDA_R_32F);
      Set(plan->description, CUBLASLT_MATMUL_DESC_BIAS_POINTER, p.bias);
      if (p.count > 1) {
        Set(plan->description, CUBLASLT_MATMUL_DESC_BIAS_BATCH_STRIDE, p.bias_step);
      }
    }
  }
  const auto layout = [&](bool transposed, int64_t slow, int64_t fast, int64_t stride,
                          int64_t step) {
    if (transposed) std::swap(slow, fast);
    return NewLayout(p.input, fast, slow, stride, p.count, step);
  };
  plan->first = layout(p.b_transposed, p.depth, p.columns, p.b_stride, p.b_step);
  plan->second = layout(p.a_transposed, p.rows, p.depth, p.a_stride, p.a_step);
  plan->result = NewLayout(p.output, p.columns, p.rows, p.d_stride, p.count, p.d_step);

  cublasLtMatmulPreference_t preference = nullptr;
  Require(cublasLtMatmulPreferenceCreate(&preference), kWhat);
  const std::unique_ptr<cublasLtMatmulPreferenceOpaque_t,
                        decltype(&cublasLtMatmulPreferenceDestroy)>
      owned(preference, &cublasLtMatmulPreferenceDestroy);
  Set(preference, CUBLASLT_MATMUL_PREF_MAX_WORKSPACE_BYTES, uint64_t{kWorkspaceBytes});
  // Sums in the result's own memory might be added in any order.
  Set(preference, CUBLASLT_MATMUL_PREF_REDUCTION_SCHEME_MASK,
      uint32_t{CUBLASLT_REDUCTION_SCHEME_COMPUTE_TYPE | CUBLASLT_REDUCTION_SCHEME_OUTPUT_TYPE});
  // By default cuBLASLt assumes 256 bytes.
  Set(preference, CUBLASLT_MATMUL_PREF_MIN_ALIGNMENT_A_BYTES,
      static_cast<uint32_t>(AlignmentOfB(p)));
  Set(preference, CUBLASLT_MATMUL_PREF_MIN_ALIGNMENT_B_BYTES,
      static_cast<uint32_t>(AlignmentOfA(p)));
  Set(preference, CUBLASLT_MATMUL_PREF_MIN_ALIGNMENT_C_BYTES,
      static_cast<uint32_t>(AlignmentOfD(p)));
  Set(preference, CUBLASLT_MATMUL_PREF_MIN_ALIGNMENT_D_BYTES,
      static_cast<uint32_t>(AlignmentOfD(p)));
  cublasLtMatmulHeuristicResult_t found{};
  int results = 0;
  const cublasStatus_t status =
      cublasLtMatmulAlgoGetHeuristic(handle_, plan->description, plan->first, plan->second,
                                     plan->result, plan->result, preference, 1, &found, &results);
  if (status == CUBLAS_STATUS_NOT_SUPPORTED || (status == CUBLAS_STATUS_SUCCESS && results == 0)) {
    return nullptr;
  }
  // cuBLASLt reports some of the epilogues that it does not support as invalid values: an f32 bias
  // of a bf16 result, for example.
  if (fused && status == CUBLAS_STATUS_INVALID_VALUE) return nullptr;
  Require(status, kWhat);
  plan->algorithm = found.algo;
  return plan;
}

CudaProducts::Plan& CudaProducts::PlanOf(const Product& product) {
  std::unique_ptr<Plan>& plan = plans_[KeyOf(product)];
  if (plan != nullptr) return *plan;
  plan = Choose(product, /*fused=*/true);
  if (plan == nullptr) plan = Choose(product, /*fused=*/false);
  if (plan == nullptr) {
    throw DeviceError("GPU: cuBLASLt has no algorithm for a product ({}, {}) x ({}, {})",
                      product.rows, product.depth, product.depth, product.columns);
  }
  return *plan;
}

void CudaProducts::Prepare(const Product& product) { PlanOf(product); }

void CudaProducts::Run(const Product& product, void* workspace, cudaStream_t stream) {
  Plan& plan = PlanOf(product);
  if (plan.fused && product.bias != nullptr) {
    Set(plan.description, CUBLASLT_MATMUL_DESC_BIAS_POINTER, product.bias);
  }
  const float one = 1, zero = 0;
  Require(cublasLtMatmul(handle_, plan.description, &one, product.b, plan.first, product.a,
                         plan.second, &zero, product.d, plan.result, product.d, plan.result,
                         &plan.algorithm, workspace, size_t{kWorkspaceBytes}, stream),
          "computing a product");
  if (!plan.fused && (product.bias != nullptr || product.relu)) {
    Launch(AfterProduct(product), stream);
  }
}

}  // namespace shoal::learner::device
