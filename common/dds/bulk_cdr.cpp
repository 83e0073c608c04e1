#include "common/dds/bulk_cdr.h"

#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace shoal::dds {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr size_t kHeaderBytes = 4;
constexpr size_t kMaxPadding = 3;

// Reads fields in order. After the first one that does not fit, everything reads as zero and
// Finished() is false.
class CdrReader {
 public:
  explicit CdrReader(std::span<const uint8_t> cdr) {
    ok_ = cdr.size() >= kHeaderBytes && cdr[0] == 0x00 && cdr[1] == 0x01;
    if (ok_) body_ = cdr.subspan(kHeaderBytes);
  }

  template <class T>
  T Read() {
    T value{};
    const std::span<const uint8_t> bytes = Take(sizeof(T), sizeof(T));
    if (ok_) std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }

  std::span<const uint8_t> ReadBytes() {
    const auto size = Read<uint32_t>();
    return Take(size, 1);
  }

  // Length includes the terminating NUL.
  std::string_view ReadString() {
    const std::span<const uint8_t> bytes = ReadBytes();
    ok_ = ok_ && !bytes.empty() && bytes.back() == 0;
    if (!ok_) return {};
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size() - 1};
  }

  bool Finished() const { return ok_ && body_.size() - position_ <= kMaxPadding; }

 private:
  std::span<const uint8_t> Take(size_t size, size_t alignment) {
    const size_t begin = (position_ + alignment - 1) / alignment * alignment;
    ok_ = ok_ && begin <= body_.size() && size <= body_.size() - begin;
    if (!ok_) return {};
    position_ = begin + size;
    return body_.subspan(begin, size);
  }

  std::span<const uint8_t> body_;
  size_t position_ = 0;
  bool ok_ = false;
};

}  // namespace

bool ParseCdr(std::span<const uint8_t> cdr, TransitionChunk* message) {
  CdrReader reader(cdr);
  const auto version = reader.Read<uint8_t>();
  message->actor = reader.Read<uint32_t>();
  message->spec_hash = reader.Read<uint64_t>();
  message->session = reader.Read<uint64_t>();
  message->first_sequence = reader.Read<uint64_t>();
  message->count = reader.Read<uint32_t>();
  message->payload = reader.ReadBytes();
  return reader.Finished() && version == kBulkVersion && message->count > 0 &&
         message->first_sequence > 0 && message->first_sequence <= UINT64_MAX - message->count &&
         !message->payload.empty() && message->payload.size() % message->count == 0;
}

bool ParseCdr(std::span<const uint8_t> cdr, BatchShard* message) {
  CdrReader reader(cdr);
  const auto version = reader.Read<uint8_t>();
  message->shard = reader.Read<uint32_t>();
  message->spec_hash = reader.Read<uint64_t>();
  message->learner_session = reader.Read<uint64_t>();
  message->request = reader.Read<uint64_t>();
  message->offset = reader.Read<uint64_t>();
  message->total_bytes = reader.Read<uint64_t>();
  message->stored_records = reader.Read<uint64_t>();
  message->stored_steps = reader.Read<uint64_t>();
  message->shards = reader.Read<uint32_t>();
  message->payload = reader.ReadBytes();
  return reader.Finished() && version == kBulkVersion && message->shard < message->shards &&
         !message->payload.empty() && message->offset <= message->total_bytes &&
         message->payload.size() <= message->total_bytes - message->offset;
}

bool ParseCdr(std::span<const uint8_t> cdr, WeightsMessage* message) {
  CdrReader reader(cdr);
  const auto version = reader.Read<uint8_t>();
  message->spec_hash = reader.Read<uint64_t>();
  message->version.session = reader.Read<uint64_t>();
  message->version.update = reader.Read<uint64_t>();
  message->env_steps = reader.Read<uint64_t>();
  message->crc = reader.Read<uint32_t>();
  message->payload = reader.ReadBytes();
  message->checkpoint = reader.ReadString();
  return reader.Finished() && version == kBulkVersion && message->version.session > 0 &&
         !message->payload.empty();
}

}  // namespace shoal::dds
