// SPDX-License-Identifier: Apache-2.0
// Records the oneDNN primitives of a piece of work and runs the primitives again without the code
// between them. Their time is the least time that the work can take with these primitives.
//
// A program that uses this header wraps dnnl_primitive_execute by a link option of the trace's
// library. Shoal's programs do not contain the trace.
#pragma once

#include <dnnl.h>

#include <functional>
#include <vector>

namespace shoal::nn {

class PrimitiveTrace {
 public:
  // Records `work`, which must run its primitives in this thread. Borrows the memory of the
  // primitives, so the networks of `work` must outlive the trace.
  explicit PrimitiveTrace(const std::function<void()>& work);

  // Selects primitives by kind; their order is kept.
  enum class Part { kAll, kConvolutions };
  // Runs the primitives in this thread, one after another, on the memory of the work.
  void Run(Part part = Part::kAll) const;
  size_t Count(Part part = Part::kAll) const;
  // Multiplications and additions of the convolutions, forward and backward, padding included.
  double ConvolutionOperations() const;

  // One execution of a primitive. The wrapped function fills it.
  struct Execution {
    const_dnnl_primitive_t primitive;
    dnnl_stream_t stream;
    std::vector<dnnl_exec_arg_t> arguments;
    bool convolution;
  };

 private:
  std::vector<Execution> executions_;
};

}  // namespace shoal::nn
