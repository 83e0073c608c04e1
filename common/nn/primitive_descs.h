// SPDX-License-Identifier: Apache-2.0
// Wrappers for declarations that differ between oneDNN 2 and 3. Debian 12 has 2.6, Debian 13 has
// 3.7.
//
// oneDNN 2 first describes an operation, then asks an engine for a primitive; oneDNN 3 does both in
// one constructor. oneDNN 3 also needs the dilation of a pooling window (none here) and the
// description of each map of a normalisation (all equal here). Primitives are for CpuEngine(). Only
// sources of common/nn and its tests include this header.
#pragma once

#include <dnnl.hpp>

#include "common/nn/op.h"

namespace shoal::nn {

#if DNNL_VERSION_MAJOR >= 3
inline dnnl::memory::dims DimsOf(const dnnl::memory::desc& desc) { return desc.get_dims(); }
inline dnnl::memory::data_type TypeOf(const dnnl::memory::desc& desc) {
  return desc.get_data_type();
}
#else
inline dnnl::memory::dims DimsOf(const dnnl::memory::desc& desc) { return desc.dims(); }
inline dnnl::memory::data_type TypeOf(const dnnl::memory::desc& desc) { return desc.data_type(); }
#endif
inline dnnl::memory::dims DimsOf(const dnnl::memory& memory) { return DimsOf(memory.get_desc()); }
inline dnnl::memory::data_type TypeOf(const dnnl::memory& memory) {
  return TypeOf(memory.get_desc());
}

// Operation: dnnl::convolution_forward, ...; what: the arguments that describe the operation, in
// oneDNN's order.
template <class Operation, class... What>
typename Operation::primitive_desc DescribeForward(const dnnl::primitive_attr& attributes,
                                                   const What&... what) {
#if DNNL_VERSION_MAJOR >= 3
  return typename Operation::primitive_desc(CpuEngine(), what..., attributes);
#else
  return typename Operation::primitive_desc(typename Operation::desc(what...), attributes,
                                            CpuEngine());
#endif
}

// forward: the description of the forward operation.
template <class Operation, class Forward, class... What>
typename Operation::primitive_desc DescribeBackward(const Forward& forward, const What&... what) {
#if DNNL_VERSION_MAJOR >= 3
  return typename Operation::primitive_desc(CpuEngine(), what..., forward, Attributes());
#else
  return typename Operation::primitive_desc(typename Operation::desc(what...), Attributes(),
                                            CpuEngine(), forward);
#endif
}

// Window of a pooling operation, in pixels.
struct PoolWindow {
  dnnl::memory::dims strides, kernel, padding;  // each {vertical, horizontal}
};

inline dnnl::pooling_forward::primitive_desc DescribePooling(dnnl::prop_kind kind,
                                                             dnnl::algorithm algorithm,
                                                             const dnnl::memory::desc& from,
                                                             const dnnl::memory::desc& to,
                                                             const PoolWindow& window) {
  const auto& [strides, kernel, padding] = window;
#if DNNL_VERSION_MAJOR >= 3
  const dnnl::memory::dims no_dilation{0, 0};
  return DescribeForward<dnnl::pooling_forward>(Attributes(), kind, algorithm, from, to, strides,
                                                kernel, no_dilation, padding, padding);
#else
  return DescribeForward<dnnl::pooling_forward>(Attributes(), kind, algorithm, from, to, strides,
                                                kernel, padding, padding);
#endif
}

inline dnnl::pooling_backward::primitive_desc DescribePoolingBackward(
    const dnnl::pooling_forward::primitive_desc& forward, dnnl::algorithm algorithm,
    const dnnl::memory::desc& source_gradient, const dnnl::memory::desc& output_gradient,
    const PoolWindow& window) {
  const auto& [strides, kernel, padding] = window;
#if DNNL_VERSION_MAJOR >= 3
  const dnnl::memory::dims no_dilation{0, 0};
  return DescribeBackward<dnnl::pooling_backward>(forward, algorithm, source_gradient,
                                                  output_gradient, strides, kernel, no_dilation,
                                                  padding, padding);
#else
  return DescribeBackward<dnnl::pooling_backward>(
      forward, algorithm, source_gradient, output_gradient, strides, kernel, padding, padding);
#endif
}

// map: the description of both source and output.
inline dnnl::batch_normalization_forward::primitive_desc DescribeNormalization(
    dnnl::prop_kind kind, const dnnl::memory::desc& map, float epsilon,
    dnnl::normalization_flags flags) {
  using Operation = dnnl::batch_normalization_forward;
#if DNNL_VERSION_MAJOR >= 3
  return DescribeForward<Operation>(Attributes(), kind, map, map, epsilon, flags);
#else
  return DescribeForward<Operation>(Attributes(), kind, map, epsilon, flags);
#endif
}

// map: the description of source, output and their gradients.
inline dnnl::batch_normalization_backward::primitive_desc DescribeNormalizationBackward(
    const dnnl::batch_normalization_forward::primitive_desc& forward, const dnnl::memory::desc& map,
    float epsilon, dnnl::normalization_flags flags) {
  using Operation = dnnl::batch_normalization_backward;
  const auto kind = dnnl::prop_kind::backward;
#if DNNL_VERSION_MAJOR >= 3
  return DescribeBackward<Operation>(forward, kind, map, map, map, epsilon, flags);
#else
  return DescribeBackward<Operation>(forward, kind, map, map, epsilon, flags);
#endif
}

// The shift as an argument of this backward pass: oneDNN 2 needs it, oneDNN 3 refuses it. Op
// ignores memory that is empty.
inline dnnl::memory ShiftOfNormalizationBackward(const dnnl::memory& shift) {
  return DNNL_VERSION_MAJOR >= 3 ? dnnl::memory() : shift;
}

// The attributes of a primitive that ends with a ReLU.
inline dnnl::primitive_attr AttributesWithRelu() {
  constexpr auto kRelu = dnnl::algorithm::eltwise_relu;
  dnnl::post_ops operations;
#if DNNL_VERSION_MAJOR >= 3
  operations.append_eltwise(kRelu, 0.f, 0.f);
#else
  operations.append_eltwise(1.f, kRelu, 0.f, 0.f);
#endif
  dnnl::primitive_attr attributes = Attributes();
  attributes.set_post_ops(operations);
  return attributes;
}

}  // namespace shoal::nn
