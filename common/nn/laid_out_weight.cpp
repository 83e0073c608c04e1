// SPDX-License-Identifier: Apache-2.0
#include "common/nn/laid_out_weight.h"

#include "common/nn/primitive_descs.h"

namespace shoal::nn {

LaidOutWeight::LaidOutWeight(const Parameter& weight, const dnnl::memory::desc& wanted,
                             std::shared_ptr<Scratchpad> scratchpad)
    : weight_(weight), f32_(PlainF32(weight.shape()), CpuEngine(), nullptr) {
  if (!weight.borrowed()) {
    from_f32_ = Relayout::Before(f32_, wanted, std::move(scratchpad));
    return;
  }
  from_f32_ = Relayout::Copying(f32_, wanted, scratchpad);
  bf16_ = dnnl::memory(Plain(weight.shape(), dnnl::memory::data_type::bf16), CpuEngine(), nullptr);
  reorders_bf16_ = Op::CanReorder(bf16_, memory());
  if (reorders_bf16_) from_bf16_ = Op::Reorder(bf16_, memory(), std::move(scratchpad));
}

void LaidOutWeight::Refresh() {
  if (weight_.borrowed()) return RefreshBorrowed();
  f32_.set_data_handle(weight_.value());
  from_f32_.Run();
}

void LaidOutWeight::RefreshBorrowed() {
  const PlainValues plain = weight_.plain();
  if (plain.data == nullptr) return;
  // What is read is not written to: oneDNN has no handle to constant memory.
  auto* data = const_cast<uint8_t*>(plain.data);
  if (plain.aligned && !plain.bf16) {
    f32_.set_data_handle(data);
    from_f32_.Run();
  } else if (plain.aligned && reorders_bf16_) {
    bf16_.set_data_handle(data);
    from_bf16_.Run();
  } else {
    std::vector<float> wide(f32_.get_desc().get_size() / sizeof(float));
    Widen(plain, int64_t(wide.size()), wide.data());
    f32_.set_data_handle(wide.data());
    from_f32_.Run();
  }
}

}  // namespace shoal::nn
