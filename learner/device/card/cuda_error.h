// SPDX-License-Identifier: Apache-2.0
// Turns errors of CUDA's libraries into Error (kDevice).
#pragma once

#include <cublasLt.h>
#include <cuda_runtime_api.h>
#include <cudnn.h>

#include "common/base/error.h"

namespace shoal::learner::device {

// `what` names the failed step: "copying to the GPU".
inline void Require(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  cudaGetLastError();  // an error that CUDA can forget must not reach the next call
  throw DeviceError("GPU: {}: {} ({})", what, cudaGetErrorString(status), cudaGetErrorName(status));
}
inline void Require(cublasStatus_t status, const char* what) {
  if (status == CUBLAS_STATUS_SUCCESS) return;
  throw DeviceError("GPU: {}: {}", what, cublasLtGetStatusString(status));
}
inline void Require(cudnnStatus_t status, const char* what) {
  if (status == CUDNN_STATUS_SUCCESS) return;
  throw DeviceError("GPU: {}: {}", what, cudnnGetErrorString(status));
}

}  // namespace shoal::learner::device
