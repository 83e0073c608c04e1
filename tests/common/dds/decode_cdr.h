// Serialised bytes to a message, the way a sample takes from the network to a subscriber's
// callback.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

// clang-format off
#include "common/dds/topics.h"
#include "common/dds/wire_types.h"
#include "dds/ddsi/ddsi_cdrstream.h"
// clang-format on

namespace shoal::dds {

// For the types that Cyclone deserialises. Nothing when Cyclone refuses the bytes or FromWire what
// they say. `bytes`: little-endian XCDR2 without its header of four bytes.
template <class M>
std::optional<M> DecodeCdr(std::string_view bytes) {
  constexpr uint32_t kXcdr2 = 2;  // what appendable types are serialised as
  const uint32_t* type = Topic<M>::kType->m_ops;
  const auto size = static_cast<uint32_t>(bytes.size());
  std::vector<uint64_t> words(bytes.size() / 8 + 1);  // aligned, as Cyclone's buffers are
  char* data = reinterpret_cast<char*>(words.data());
  std::memcpy(data, bytes.data(), size);
  uint32_t offset = 0;
  if (dds_stream_normalize_data(data, &offset, size, /*bswap=*/false, kXcdr2, type) == nullptr) {
    return std::nullopt;
  }
  dds_istream_t in;
  dds_istream_init(&in, size, data, kXcdr2);
  typename Topic<M>::Wire wire{};
  dds_stream_read(&in, reinterpret_cast<char*>(&wire), type);
  M message;
  const bool good = FromWire(wire, &message);
  dds_stream_free_sample(&wire, type);
  return good ? std::optional(std::move(message)) : std::nullopt;
}

}  // namespace shoal::dds
