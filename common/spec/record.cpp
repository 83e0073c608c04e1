// SPDX-License-Identifier: Apache-2.0
#include "common/spec/record.h"

#include <cmath>

namespace shoal {

RecordLayout::RecordLayout(const ObservationSpec& spec)
    : action_size_(spec.action_size),
      drawn_size_(spec.drawn_actions ? spec.action_size : 0),
      vector_size_(spec.RecordedVectorSize()),
      frame_bytes_(spec.FrameBytes()) {
  drawn_offset_ = static_cast<int>(sizeof(RecordHeader)) + 4 * action_size_;
  vector_offset_ = drawn_offset_ + 4 * drawn_size_;
  frame_offset_ = vector_offset_ + 4 * vector_size_;
  record_bytes_ = (frame_offset_ + frame_bytes_ + 7) / 8 * 8;
}

const char* RecordFault(const RecordLayout& layout, const uint8_t* record) {
  const RecordHeader& header = RecordLayout::Header(record);
  if (header.version != kRecordVersion) return "record version is unknown";
  if (header.kind != RecordKind::kReset && header.kind != RecordKind::kStep &&
      header.kind != RecordKind::kGoal) {
    return "record kind is unknown";
  }
  if ((header.kind == RecordKind::kStep) == (header.index == 0)) {
    return "record index does not fit its kind";
  }
  if ((header.flags & ~(kTerminated | kTruncated | kSuccess)) != 0) return "unknown record flags";
  if (!std::isfinite(header.reward)) return "reward is not finite";
  if (!std::isfinite(header.log_prob)) return "log-probability is not finite";
  for (float a : layout.Action(record)) {
    if (!(a >= -1.0f && a <= 1.0f)) return "action is outside [-1, 1]";
  }
  for (float a : layout.DrawnAction(record)) {
    if (!std::isfinite(a)) return "drawn action is not finite";
  }
  for (float v : layout.Vector(record)) {
    if (!std::isfinite(v)) return "vector observation is not finite";
  }
  return nullptr;
}

}  // namespace shoal
