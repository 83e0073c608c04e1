// SPDX-License-Identifier: Apache-2.0
// Products (commands.h) by cuBLASLt. f32 products use no TF32. Algorithms with a fixed order of
// sums are chosen once for each shape and alignment of the operands.
//
// A bias or ReLU is part of the product where cuBLASLt has an algorithm for it, else it follows as
// a kernel of its own.
#pragma once

#include <cublasLt.h>
#include <cuda_runtime_api.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>

#include "learner/device/commands.h"

namespace shoal::learner::device {

class CudaProducts {
 public:
  CudaProducts();
  ~CudaProducts();
  CudaProducts(const CudaProducts&) = delete;
  CudaProducts& operator=(const CudaProducts&) = delete;

  // Workspace that any product may take.
  static constexpr int64_t kWorkspaceBytes = int64_t{32} << 20;

  // Chooses the algorithm. Call it before a capture. Throws Error (kDevice).
  void Prepare(const Product& product);
  // Submits the product; `workspace` has kWorkspaceBytes. Throws Error (kDevice).
  void Run(const Product& product, void* workspace, cudaStream_t stream);

 private:
  struct Plan;
  using Key = std::array<int64_t, 20>;

  static Key KeyOf(const Product& product);
  Plan& PlanOf(const Product& product);
  // Returns null if there is no algorithm, or if cuBLASLt refuses the product when it is `fused`.
  std::unique_ptr<Plan> Choose(const Product& product, bool fused) const;

  cublasLtHandle_t handle_ = nullptr;
  std::map<Key, std::unique_ptr<Plan>> plans_;
};

}  // namespace shoal::learner::device
