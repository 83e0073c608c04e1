// SPDX-License-Identifier: Apache-2.0
// A (B, N) array of f32, with a copy in the compute type of large products.
#pragma once

#include "common/nn/op.h"
#include "common/nn/precision.h"

namespace shoal::nn {

class Rows {
 public:
  // Throws UsageError if size() overflows an int.
  Rows(int batch, int columns, Precision precision);

  int batch() const { return batch_; }
  int columns() const { return columns_; }
  float* values() { return static_cast<float*>(f32_.get_data_handle()); }
  const float* values() const { return static_cast<const float*>(f32_.get_data_handle()); }
  int size() const { return batch_ * columns_; }

  // Copies (B, count) into columns first .. first + count - 1.
  void SetColumns(int first, int count, const float* source);
  // Rounds the values into the copy. Does nothing if the compute type is f32.
  void Commit();

  const dnnl::memory& f32() const { return f32_; }
  const dnnl::memory& compute() const { return compute_; }

 private:
  int batch_, columns_;
  dnnl::memory f32_, compute_;  // the same memory if the compute type is f32
};

}  // namespace shoal::nn
