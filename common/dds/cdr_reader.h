// SPDX-License-Identifier: Apache-2.0
// Reads values from serialised CDR. Every read is bounds-checked, because the bytes come from the
// network. Internal.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shoal::dds {

static_assert(std::endian::native == std::endian::little);

// Serialisation of a type's body. The value is the second byte of the 4-byte header; the first byte
// is 0.
enum class CdrEncoding : uint8_t {
  kPlain1 = 1,      // @final type: fields are aligned to their size
  kDelimited2 = 9,  // @appendable type: alignment at most 4; structs and collections have a size
};

// Reads fields in order. If a field does not fit, this field and all later fields read as zero, and
// Finished() is false.
class CdrReader {
 public:
  CdrReader(std::span<const uint8_t> cdr, CdrEncoding encoding)
      : alignment_(encoding == CdrEncoding::kPlain1 ? 8 : 4) {
    ok_ = cdr.size() >= kHeaderBytes && cdr[0] == 0 && cdr[1] == static_cast<uint8_t>(encoding);
    if (ok_) body_ = cdr.subspan(kHeaderBytes);
  }

  template <class T>
  T Read() {
    T value{};
    if (Absent()) return value;
    const std::span<const uint8_t> bytes = Take(sizeof(T), sizeof(T));
    if (ok_) std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }

  std::span<const uint8_t> ReadBytes() {
    const auto size = Read<uint32_t>();
    return Take(size, 1);
  }

  // The string up to its first NUL. Fails unless the last byte is NUL.
  std::string_view ReadString() {
    if (Absent()) return {};
    const std::span<const uint8_t> bytes = ReadBytes();
    ok_ = ok_ && !bytes.empty() && bytes.back() == 0;
    if (!ok_) return {};
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return text.substr(0, text.find('\0'));
  }

  std::vector<std::string> ReadStrings() {
    std::vector<std::string> strings;
    ReadCollection([&] { strings.emplace_back(ReadString()); });
    return strings;
  }

  template <class T>
  std::vector<T> ReadNumbers() {
    const auto count = Read<uint32_t>();
    if (count == 0) return {};
    const std::span<const uint8_t> bytes = Take(size_t{count} * sizeof(T), sizeof(T));
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

  // Reads a struct to which later versions may add fields. Fields that an older sender left out
  // read as zero; fields that a newer sender added are skipped.
  template <class ReadFields>
  void ReadAppendable(ReadFields read_fields) {
    ReadScope(/*may_lack=*/true, read_fields);
  }

  // Reads a sequence of strings or structs. Calls read_element for each element.
  template <class ReadElement>
  void ReadCollection(ReadElement read_element) {
    if (Absent()) return;
    ReadScope(/*may_lack=*/false, [&] {
      const auto count = Read<uint32_t>();
      for (uint32_t i = 0; i < count && ok_; ++i) read_element();
    });
  }

  // Whether all reads succeeded and the body has no more bytes than padding.
  bool Finished() const { return ok_ && body_.size() - position_ <= kMaxPadding; }

 private:
  static constexpr size_t kHeaderBytes = 4;
  static constexpr size_t kMaxPadding = 3;

  // Reads a size, then calls `read` for a part of this size. Afterwards the position is the end of
  // the part, even if `read` has read less.
  template <class ReadPart>
  void ReadScope(bool may_lack, ReadPart read) {
    const std::span<const uint8_t> part = Take(Read<uint32_t>(), 1);
    if (!ok_) return;
    const size_t end_before = end_, end = position_;
    const bool may_lack_before = may_lack_;
    position_ -= part.size();
    end_ = end;
    may_lack_ = may_lack;
    read();
    position_ = end;
    end_ = end_before;
    may_lack_ = may_lack_before;
  }

  bool Absent() const { return may_lack_ && position_ == end_; }

  std::span<const uint8_t> Take(size_t size, size_t alignment) {
    alignment = std::min(alignment, alignment_);
    const size_t begin = (position_ + alignment - 1) / alignment * alignment;
    const size_t end = std::min(end_, body_.size());
    ok_ = ok_ && begin <= end && size <= end - begin;
    if (!ok_) return {};
    position_ = begin + size;
    return body_.subspan(begin, size);
  }

  const size_t alignment_;  // largest alignment of a field
  std::span<const uint8_t> body_;
  size_t position_ = 0;
  size_t end_ = std::numeric_limits<size_t>::max();  // end of the innermost part
  bool may_lack_ = false;                            // whether this part may lack its last fields
  bool ok_ = false;
};

}  // namespace shoal::dds
