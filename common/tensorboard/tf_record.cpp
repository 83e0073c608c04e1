// SPDX-License-Identifier: Apache-2.0
#include "common/tensorboard/tf_record.h"

#include <cstdint>

#include "common/tensorboard/crc32c.h"

namespace shoal::tensorboard {
namespace {

void AppendLittleEndian(uint64_t value, int bytes, std::string* out) {
  for (int i = 0; i < bytes; ++i) out->push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

}  // namespace

void AppendTfRecord(std::string_view payload, std::string* out) {
  std::string length;
  AppendLittleEndian(payload.size(), 8, &length);
  out->append(length);
  AppendLittleEndian(MaskCrc(Crc32c(length)), 4, out);
  out->append(payload);
  AppendLittleEndian(MaskCrc(Crc32c(payload)), 4, out);
}

}  // namespace shoal::tensorboard
