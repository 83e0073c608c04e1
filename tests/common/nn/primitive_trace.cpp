// SPDX-License-Identifier: Apache-2.0
#include "tests/common/nn/primitive_trace.h"

#include <algorithm>

#include "common/base/check.h"
#include "common/nn/primitive_descs.h"

namespace {

using Execution = shoal::nn::PrimitiveTrace::Execution;

// List of this thread's executions; null: not recorded.
thread_local std::vector<Execution>* notes = nullptr;

bool IsConvolution(const_dnnl_primitive_t primitive) {
  const_dnnl_primitive_desc_t desc = nullptr;
  dnnl_primitive_kind_t kind = dnnl_undefined_primitive;
  CHECK(dnnl_primitive_get_primitive_desc(primitive, &desc) == dnnl_success);
  CHECK(dnnl_primitive_desc_query(desc, dnnl_query_primitive_kind, 0, &kind) == dnnl_success);
  return kind == dnnl_convolution;
}

// The dimensions of the first of two arguments that there is: values or gradients.
dnnl::memory::dims DimsOfArgument(const Execution& execution, int values, int gradients) {
  for (const int index : {values, gradients}) {
    const auto found = std::ranges::find(execution.arguments, index, &dnnl_exec_arg_t::arg);
    if (found != execution.arguments.end()) {
      return shoal::nn::DimsOf(dnnl::memory(found->memory, /*weak=*/true));
    }
  }
  CHECK(false) << "a convolution without argument " << values;
  return {};
}

// Each of (B, N, h, w) outputs, or its gradient, meets the (C, u, v) weights of its filter once.
double OperationsOf(const Execution& execution) {
  double operations = 2;
  for (const int64_t size : DimsOfArgument(execution, DNNL_ARG_DST, DNNL_ARG_DIFF_DST)) {
    operations *= double(size);
  }
  const dnnl::memory::dims weights =
      DimsOfArgument(execution, DNNL_ARG_WEIGHTS, DNNL_ARG_DIFF_WEIGHTS);
  for (size_t i = 1; i < weights.size(); ++i) operations *= double(weights[i]);
  return operations;
}

}  // namespace

// Names that the linker's --wrap asks for.
extern "C" dnnl_status_t __real_dnnl_primitive_execute(const_dnnl_primitive_t, dnnl_stream_t, int,
                                                       const dnnl_exec_arg_t*);
extern "C" dnnl_status_t __wrap_dnnl_primitive_execute(const_dnnl_primitive_t primitive,
                                                       dnnl_stream_t stream, int count,
                                                       const dnnl_exec_arg_t* arguments) {
  if (notes != nullptr) {
    notes->push_back({primitive, stream, {arguments, arguments + count}, IsConvolution(primitive)});
  }
  return __real_dnnl_primitive_execute(primitive, stream, count, arguments);
}

namespace shoal::nn {

PrimitiveTrace::PrimitiveTrace(const std::function<void()>& work) {
  CHECK(notes == nullptr) << "a trace within a trace";
  notes = &executions_;
  work();
  notes = nullptr;
}

void PrimitiveTrace::Run(Part part) const {
  for (const Execution& execution : executions_) {
    if (part == Part::kConvolutions && !execution.convolution) continue;
    const dnnl_status_t status =
        __real_dnnl_primitive_execute(execution.primitive, execution.stream,
                                      int(execution.arguments.size()), execution.arguments.data());
    CHECK(status == dnnl_success) << "oneDNN status " << int(status);
  }
}

size_t PrimitiveTrace::Count(Part part) const {
  if (part == Part::kAll) return executions_.size();
  return size_t(std::ranges::count_if(executions_, &Execution::convolution));
}

double PrimitiveTrace::ConvolutionOperations() const {
  double operations = 0;
  for (const Execution& execution : executions_) {
    if (execution.convolution) operations += OperationsOf(execution);
  }
  return operations;
}

}  // namespace shoal::nn
