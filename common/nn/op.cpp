// SPDX-License-Identifier: Apache-2.0
#include "common/nn/op.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "common/base/check.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

const dnnl::stream& CpuStream() {
  static thread_local const dnnl::stream stream(CpuEngine());
  return stream;
}

}  // namespace

const dnnl::engine& CpuEngine() {
  static const dnnl::engine engine(dnnl::engine::kind::cpu, 0);
  return engine;
}

dnnl::memory::desc Plain(const dnnl::memory::dims& dims, dnnl::memory::data_type type) {
  dnnl::memory::dims strides(dims.size(), 1);
  for (size_t i = dims.size() - 1; i > 0; --i) strides[i - 1] = strides[i] * dims[i];
  return dnnl::memory::desc(dims, type, strides);
}

dnnl::memory::desc AnyLayout(const dnnl::memory::dims& dims, dnnl::memory::data_type type) {
  return dnnl::memory::desc(dims, type, dnnl::memory::format_tag::any);
}

dnnl::memory MakeMemory(const dnnl::memory::desc& desc) {
  dnnl::memory memory(desc, CpuEngine());
  std::memset(memory.get_data_handle(), 0, desc.get_size());
  return memory;
}

dnnl::primitive_attr Attributes() {
  dnnl::primitive_attr attributes;
  attributes.set_scratchpad_mode(dnnl::scratchpad_mode::user);
  return attributes;
}

void Scratchpad::Reserve(const dnnl::memory::desc& desc) {
  bytes_ = std::max(bytes_, desc.get_size());
}

void* Scratchpad::Data() {
  if (!memory_ || memory_.get_desc().get_size() < bytes_) {
    memory_ = MakeMemory(
        dnnl::memory::desc({dnnl::memory::dim(bytes_)}, dnnl::memory::data_type::u8, {1}));
  }
  return memory_.get_data_handle();
}

Op::Op(dnnl::primitive primitive, const dnnl::memory::desc& scratch,
       std::initializer_list<std::pair<int, dnnl::memory>> arguments,
       std::shared_ptr<Scratchpad> scratchpad)
    : primitive_(std::move(primitive)), scratchpad_(std::move(scratchpad)) {
  for (const auto& [index, memory] : arguments) {
    // An absent argument, such as the bias of a layer without one.
    if (!memory) continue;
    memories_.push_back(memory);
    arguments_.push_back({index, memory.get()});
  }
  if (scratch.get_size() > 0) {
    scratchpad_->Reserve(scratch);
    scratch_ = dnnl::memory(scratch, CpuEngine(), nullptr);
    arguments_.push_back({DNNL_ARG_SCRATCHPAD, scratch_.get()});
  }
}

bool Op::CanReorder(const dnnl::memory& from, const dnnl::memory& to) {
  const dnnl::engine& engine = CpuEngine();
  return bool(dnnl::reorder::primitive_desc(engine, from.get_desc(), engine, to.get_desc(),
                                            Attributes(), /*allow_empty=*/true));
}

Op Op::Reorder(const dnnl::memory& from, const dnnl::memory& to,
               std::shared_ptr<Scratchpad> scratchpad) {
  const dnnl::reorder::primitive_desc desc(from, to, Attributes());
  return Op(desc, {{DNNL_ARG_FROM, from}, {DNNL_ARG_TO, to}}, std::move(scratchpad));
}

Op Op::ReorderPart(const dnnl::memory& from, const dnnl::memory::desc& from_part,
                   const dnnl::memory& to, const dnnl::memory::desc& to_part,
                   std::shared_ptr<Scratchpad> scratchpad) {
  const dnnl::reorder::primitive_desc desc(CpuEngine(), from_part, CpuEngine(), to_part,
                                           Attributes());
  return Op(desc, {{DNNL_ARG_FROM, from}, {DNNL_ARG_TO, to}}, std::move(scratchpad));
}

void Op::Run() {
  CHECK(InThreadScope()) << "a product outside a ThreadScope";
  // The shared scratchpad may have grown since this operation was built.
  if (scratch_) scratch_.set_data_handle(scratchpad_->Data());
  const dnnl_status_t status = dnnl_primitive_execute(primitive_.get(), CpuStream().get(),
                                                      int(arguments_.size()), arguments_.data());
  CHECK(status == dnnl_success) << "oneDNN status " << int(status);
}

Relayout Relayout::Before(const dnnl::memory& source, const dnnl::memory::desc& wanted,
                          std::shared_ptr<Scratchpad> scratchpad) {
  if (source.get_desc() != wanted) return Copying(source, wanted, std::move(scratchpad));
  Relayout result;
  result.memory_ = source;
  return result;
}

Relayout Relayout::Copying(const dnnl::memory& source, const dnnl::memory::desc& wanted,
                           std::shared_ptr<Scratchpad> scratchpad) {
  return Into(source, MakeMemory(wanted), std::move(scratchpad));
}

Relayout Relayout::Into(const dnnl::memory& source, const dnnl::memory& target,
                        std::shared_ptr<Scratchpad> scratchpad) {
  Relayout result;
  result.memory_ = target;
  result.reorder_ = Op::Reorder(source, result.memory_, std::move(scratchpad));
  result.needed_ = true;
  return result;
}

Relayout Relayout::After(const dnnl::memory::desc& produced, const dnnl::memory& target,
                         std::shared_ptr<Scratchpad> scratchpad) {
  Relayout result;
  result.memory_ = target;
  if (target.get_desc() != produced) {
    result.memory_ = MakeMemory(produced);
    result.reorder_ = Op::Reorder(result.memory_, target, std::move(scratchpad));
    result.needed_ = true;
  }
  return result;
}

}  // namespace shoal::nn
