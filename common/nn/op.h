// SPDX-License-Identifier: Apache-2.0
// A oneDNN primitive bound to its memories. Only common/nn includes this header.
#pragma once

#include <dnnl.hpp>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "common/nn/precision.h"

namespace shoal::nn {

// The CPU engine of the process.
const dnnl::engine& CpuEngine();

// Type of the inputs of large products; their sums are always f32.
inline dnnl::memory::data_type ComputeType(Precision precision) {
  return precision == Precision::kBf16 ? dnnl::memory::data_type::bf16
                                       : dnnl::memory::data_type::f32;
}

// Row-major description of `dims`.
dnnl::memory::desc Plain(const dnnl::memory::dims& dims, dnnl::memory::data_type type);
inline dnnl::memory::desc PlainF32(const dnnl::memory::dims& dims) {
  return Plain(dims, dnnl::memory::data_type::f32);
}
// Description that lets the primitive choose the layout.
dnnl::memory::desc AnyLayout(const dnnl::memory::dims& dims, dnnl::memory::data_type type);
// Zeroed memory, owned by the handle.
dnnl::memory MakeMemory(const dnnl::memory::desc& desc);

// Attributes with which every primitive is built. Shoal provides the scratch memory, because
// oneDNN's own scratch memory belongs to a thread, and one thread may build a network that another
// thread runs.
dnnl::primitive_attr Attributes();

// Scratch memory that the operations of one network share, because they run one after another.
class Scratchpad {
 public:
  // Requests memory of at least this size. Call it while a network is built.
  void Reserve(const dnnl::memory::desc& desc);
  // Returns the memory. The first call allocates it.
  void* Data();

 private:
  size_t bytes_ = 0;
  dnnl::memory memory_;
};

// One primitive with its arguments; arguments with empty memory are left out. Movable; the memories
// are shared handles. One thread at a time calls Run(), under a ThreadScope of the same size as
// during construction.
class Op {
 public:
  Op() = default;
  template <class PrimitiveDesc>
  Op(const PrimitiveDesc& desc, std::initializer_list<std::pair<int, dnnl::memory>> arguments,
     std::shared_ptr<Scratchpad> scratchpad)
      : Op(dnnl::primitive(desc.get()), desc.scratchpad_desc(), arguments, std::move(scratchpad)) {}
  // Whether oneDNN can copy `from` to `to`, with a change of layout and type.
  static bool CanReorder(const dnnl::memory& from, const dnnl::memory& to);
  // Returns an operation that makes this copy.
  static Op Reorder(const dnnl::memory& from, const dnnl::memory& to,
                    std::shared_ptr<Scratchpad> scratchpad);
  // Does the same for the parts of the memories that `from_part` and `to_part` describe.
  static Op ReorderPart(const dnnl::memory& from, const dnnl::memory::desc& from_part,
                        const dnnl::memory& to, const dnnl::memory::desc& to_part,
                        std::shared_ptr<Scratchpad> scratchpad);

  void Run();

 private:
  Op(dnnl::primitive primitive, const dnnl::memory::desc& scratch,
     std::initializer_list<std::pair<int, dnnl::memory>> arguments,
     std::shared_ptr<Scratchpad> scratchpad);

  dnnl::primitive primitive_;
  std::vector<dnnl::memory> memories_;
  std::vector<dnnl_exec_arg_t> arguments_;
  dnnl::memory scratch_;  // empty if the primitive needs none
  std::shared_ptr<Scratchpad> scratchpad_;
};

// Memory in the layout that one primitive requires, and a conversion from or to the memory that all
// other code uses. If the two layouts are equal, the two memories are the same and Run does
// nothing.
class Relayout {
 public:
  Relayout() = default;
  // Run() converts `source` to the layout `wanted`, before a primitive that reads memory().
  static Relayout Before(const dnnl::memory& source, const dnnl::memory::desc& wanted,
                         std::shared_ptr<Scratchpad> scratchpad);
  // Like Before, but memory() is always a copy, even if the layouts are equal.
  static Relayout Copying(const dnnl::memory& source, const dnnl::memory::desc& wanted,
                          std::shared_ptr<Scratchpad> scratchpad);
  // Like Before, but Run() converts into `target`, which has the wanted layout.
  static Relayout Into(const dnnl::memory& source, const dnnl::memory& target,
                       std::shared_ptr<Scratchpad> scratchpad);
  // Run() copies memory(), which a primitive wrote in the layout `produced`, to `target`.
  static Relayout After(const dnnl::memory::desc& produced, const dnnl::memory& target,
                        std::shared_ptr<Scratchpad> scratchpad);

  const dnnl::memory& memory() const { return memory_; }
  void Run() {
    if (needed_) reorder_.Run();
  }

 private:
  dnnl::memory memory_;
  Op reorder_;
  bool needed_ = false;
};

}  // namespace shoal::nn
