// SPDX-License-Identifier: Apache-2.0
#include "common/nn/laid_out_weight.h"

#include <algorithm>

#include "common/nn/primitive_descs.h"

namespace shoal::nn {

namespace {

constexpr dnnl::memory::dim kPieceElements = 8192;  // about 6 us, of which 1 us is the call
constexpr dnnl::memory::dim kPieceUnit = 64;        // no layout has larger blocks

// Consecutive ranges of one dimension of a weight. Each is `length` long, except the last.
struct Pieces {
  int dimension = 0, count = 1;
  dnnl::memory::dim length = 0;
};

// Cuts the longest dimension into pieces of whole blocks. oneDNN cannot describe a part of a padded
// block, so the last piece must end with the dimension. Other weights stay whole.
Pieces Cut(const dnnl::memory::dims& shape) {
  const auto longest = std::ranges::max_element(shape);
  dnnl::memory::dim elements = 1;
  for (const dnnl::memory::dim size : shape) elements *= size;
  const auto most = int(*longest / kPieceUnit);
  if (*longest % kPieceUnit != 0 || most < 2 || elements < 2 * kPieceElements) {
    return {0, 1, shape[0]};
  }
  const auto wanted = std::min(most, int(elements / kPieceElements));
  const dnnl::memory::dim length = (most + wanted - 1) / wanted * kPieceUnit;
  return {int(longest - shape.begin()), int((*longest + length - 1) / length), length};
}

dnnl::memory::desc PieceOf(const dnnl::memory::desc& desc, const Pieces& pieces, int piece) {
  dnnl::memory::dims sizes = DimsOf(desc), offsets(sizes.size(), 0);
  const auto d = size_t(pieces.dimension);
  offsets[d] = piece * pieces.length;
  sizes[d] = std::min(pieces.length, sizes[d] - offsets[d]);
  return desc.submemory_desc(sizes, offsets, /*allow_empty=*/true);
}

}  // namespace

const SharedLayouts::Layout* SharedLayouts::Join(int64_t offset, const dnnl::memory::desc& wanted,
                                                 int pieces, int rank, bool* first_of_rank) {
  auto found = std::ranges::find_if(layouts_, [&](const Layout& layout) {
    return layout.offset == offset && layout.memory.get_desc() == wanted;
  });
  if (found == layouts_.end()) {
    layouts_.push_back({offset, MakeMemory(wanted), next_turn_, {}});
    next_turn_ += pieces;
    found = std::prev(layouts_.end());
  }
  *first_of_rank = found->ranks.empty() || found->ranks.back() != rank;
  if (*first_of_rank) found->ranks.push_back(rank);
  return &*found;
}

LaidOutWeight::LaidOutWeight(const Parameter& weight, const dnnl::memory::desc& wanted,
                             std::shared_ptr<Scratchpad> scratchpad)
    : weight_(weight), f32_(PlainF32(weight.shape()), CpuEngine(), nullptr) {
  SharedLayouts* layouts = weight.set().layouts();
  // No layout is shared without other replicas, or if the weight already has the wanted layout.
  if (!weight.borrowed() && (layouts == nullptr || f32_.get_desc() == wanted)) {
    from_f32_ = Relayout::Before(f32_, wanted, std::move(scratchpad));
    return;
  }
  if (!weight.borrowed()) {
    Share(layouts, wanted, scratchpad);
    return;
  }
  from_f32_ = Relayout::Copying(f32_, wanted, scratchpad);
  bf16_ = dnnl::memory(Plain(weight.shape(), dnnl::memory::data_type::bf16), CpuEngine(), nullptr);
  reorders_bf16_ = Op::CanReorder(bf16_, memory());
  if (reorders_bf16_) from_bf16_ = Op::Reorder(bf16_, memory(), std::move(scratchpad));
}

void LaidOutWeight::Share(SharedLayouts* layouts, const dnnl::memory::desc& wanted,
                          const std::shared_ptr<Scratchpad>& scratchpad) {
  const dnnl::memory::desc plain = f32_.get_desc();
  Pieces pieces = Cut(weight_.shape());
  // A layout that cannot be cut is written as one piece.
  if (!PieceOf(wanted, pieces, pieces.count - 1)) pieces = {0, 1, weight_.shape()[0]};
  bool writes = false;
  shared_ = layouts->Join(weight_.offset(), wanted, pieces.count, weight_.set().rank(), &writes);
  from_f32_ = Relayout::Into(f32_, shared_->memory, scratchpad);
  for (int piece = 0; writes && piece < pieces.count; ++piece) {
    const bool whole = pieces.count == 1;
    pieces_.push_back(Op::ReorderPart(f32_, whole ? plain : PieceOf(plain, pieces, piece),
                                      shared_->memory,
                                      whole ? wanted : PieceOf(wanted, pieces, piece), scratchpad));
  }
}

void LaidOutWeight::Refresh() {
  if (weight_.borrowed()) return RefreshBorrowed();
  f32_.set_data_handle(weight_.value());
  if (shared_ == nullptr) return from_f32_.Run();
  for (size_t piece = 0; piece < pieces_.size(); ++piece) {
    if (shared_->Writes(weight_.set().rank(), piece)) pieces_[piece].Run();
  }
}

void LaidOutWeight::RefreshBorrowed() {
  const PlainValues plain = weight_.plain();
  if (plain.data == nullptr) return;
  // The memory is only read, but oneDNN has no handle to constant memory.
  auto* data = const_cast<uint8_t*>(plain.data);
  if (plain.aligned && !plain.bf16) {
    f32_.set_data_handle(data);
    from_f32_.Run();
  } else if (plain.aligned && reorders_bf16_) {
    bf16_.set_data_handle(data);
    from_bf16_.Run();
  } else {
    // Unaligned values, and bf16 values that oneDNN cannot reorder, are widened first.
    std::vector<float> wide(f32_.get_desc().get_size() / sizeof(float));
    Widen(plain, int64_t(wide.size()), wide.data());
    f32_.set_data_handle(wide.data());
    from_f32_.Run();
  }
}

}  // namespace shoal::nn
