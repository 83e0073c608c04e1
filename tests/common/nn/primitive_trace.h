// SPDX-License-Identifier: Apache-2.0
// Which oneDNN primitives a piece of work runs, to run them again without what lies between them:
// the least time that the work can take with these primitives.
//
// A program that uses this is linked with dnnl_primitive_execute wrapped (the library's link option
// says so): nothing of the product knows.
#pragma once

#include <dnnl.h>

#include <functional>
#include <vector>

namespace shoal::nn {

class PrimitiveTrace {
 public:
  // Runs `work`, which runs its primitives in this thread. What they read and write stays borrowed:
  // the networks of `work` outlive the trace.
  explicit PrimitiveTrace(const std::function<void()>& work);

  // Those of some kind alone; the same primitives, in the same order.
  enum class Part { kAll, kConvolutions };
  // Runs them in this thread, one after another, over memory as the work left it.
  void Run(Part part = Part::kAll) const;
  size_t Count(Part part = Part::kAll) const;
  // Multiplications and additions of the convolutions, forward and backward, padding included.
  double ConvolutionOperations() const;

  // One execution. For the wrapped function.
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
