// SPDX-License-Identifier: Apache-2.0
// Encoding of a message by Cyclone.
#pragma once

#include <cstdint>
#include <vector>

#include "common/base/check.h"

// clang-format off
#include "common/dds/wire_type.h"
#include "common/dds/wire_types.h"
#include "dds/ddsi/ddsi_cdrstream.h"
// clang-format on

namespace shoal::dds {

// Returns the serialised message, including the header of four bytes. Not for bulk types.
template <class M>
std::vector<uint8_t> EncodeCdr(const M& message) {
  constexpr uint32_t kXcdr2 = 2;  // encoding of appendable types
  WireBuffers buffers;
  const auto wire = ToWire(message, &buffers);
  dds_ostream_t out;
  dds_ostream_init(&out, 0, kXcdr2);
  CHECK(dds_stream_write(&out, reinterpret_cast<const char*>(&wire),
                         WireType<M>::kDescriptor->m_ops));
  std::vector<uint8_t> cdr{0, 9, 0, 0};
  cdr.insert(cdr.end(), out.m_buffer, out.m_buffer + out.m_index);
  dds_ostream_fini(&out);
  return cdr;
}

}  // namespace shoal::dds
