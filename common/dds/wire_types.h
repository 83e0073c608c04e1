// SPDX-License-Identifier: Apache-2.0
// Converts the plain structs of common/wire to the C structs that idlc generates, field by field in
// the order of common/wire/message_fields.h. bulk_cdr.h and message_cdr.h parse received messages.
// Internal.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "common/base/check.h"
#include "common/dds/bulk_cdr.h"
#include "common/dds/wire_type.h"
#include "common/wire/message_fields.h"

namespace shoal::dds {

// Memory for sequences whose elements have another layout in the generated structs than in the
// message. The writer keeps the buffers between calls.
struct WireBuffers {
  std::vector<char*> strings;
  std::tuple<std::vector<shoal_idl_Credit>, std::vector<shoal_idl_EvaluationRequest>,
             std::vector<shoal_idl_Metrics>, std::vector<shoal_idl_RunEvent>>
      structs;
};

// Converts to each of idlc's sequence types with elements E; these types differ only in their
// names.
template <class E>
struct WireSequence {
  E* elements;
  size_t size;

  template <class S>
  requires std::same_as<decltype(S::_buffer), E*>
  operator S() const {  // NOLINT(google-explicit-constructor): initialises a field of that type
    const auto count = static_cast<uint32_t>(size);
    return {count, count, elements, false};
  }
};

// Converts the fields of one message. The generated C structs have no const pointers, but dds_write
// only reads through the pointers.
class FieldWriter {
 public:
  // Borrows the buffers and drops their former content.
  template <HasFields M>
  FieldWriter(const M& message, WireBuffers* buffers) : buffers_(buffers) {
    buffers_->strings.clear();
    buffers_->strings.reserve(StringsIn(message));
  }

  template <HasFields M>
  typename WireType<M>::Wire Write(const M& message) {
    return std::apply(
        [&](const auto&... field) -> typename WireType<M>::Wire {
          if constexpr (requires { BulkVersion(&message); }) {
            return {BulkVersion(&message), Borrow(field)...};
          } else {
            return {Borrow(field)...};
          }
        },
        FieldsOf(message));
  }

 private:
  // Number of strings in all sequences of the message. Memory for all pointers is reserved at once,
  // so that the pointers do not move.
  template <HasFields M>
  static size_t StringsIn(const M& message) {
    return std::apply([](const auto&... field) { return (StringsIn(field) + ... + size_t{0}); },
                      FieldsOf(message));
  }
  static size_t StringsIn(const std::vector<std::string>& strings) { return strings.size(); }
  template <HasFields E>
  static size_t StringsIn(const std::vector<E>& elements) {
    size_t strings = 0;
    for (const E& element : elements) strings += StringsIn(element);
    return strings;
  }
  template <class T>
  static size_t StringsIn(const T&) {
    return 0;
  }

  template <class T>
  requires std::is_arithmetic_v<T> T Borrow(T number) { return number; }
  template <class T>
  requires std::is_enum_v<T> std::underlying_type_t<T> Borrow(T word) {
    return static_cast<std::underlying_type_t<T>>(word);
  }
  char* Borrow(const std::string& text) { return const_cast<char*>(text.c_str()); }
  char* Borrow(const LongText<const std::string>& field) { return Borrow(field.text); }
  WireSequence<uint8_t> Borrow(std::span<const uint8_t> bytes) {
    return {const_cast<uint8_t*>(bytes.data()), bytes.size()};
  }
  template <class T>
  requires std::is_arithmetic_v<T> WireSequence<T> Borrow(const std::vector<T>& values) {
    return {const_cast<T*>(values.data()), values.size()};
  }
  WireSequence<char*> Borrow(const std::vector<std::string>& strings) {
    std::vector<char*>& pointers = buffers_->strings;
    CHECK(pointers.capacity() - pointers.size() >= strings.size());
    char** first = pointers.data() + pointers.size();
    for (const std::string& text : strings) pointers.push_back(Borrow(text));
    return {first, strings.size()};
  }
  // A message has at most one sequence of each struct.
  template <HasFields E>
  WireSequence<typename WireType<E>::Wire> Borrow(const std::vector<E>& elements) {
    auto& structs = std::get<std::vector<typename WireType<E>::Wire>>(buffers_->structs);
    structs.clear();
    structs.reserve(elements.size());
    for (const E& element : elements) structs.push_back(Write(element));
    return {structs.data(), structs.size()};
  }

  WireBuffers* const buffers_;
};

// Strings and payloads of the result point into the message and the buffers. The result is valid
// until the next call with the same buffers, and as long as message and buffers live.
template <HasFields M>
typename WireType<M>::Wire ToWire(const M& message, WireBuffers* buffers) {
  return FieldWriter(message, buffers).Write(message);
}

}  // namespace shoal::dds
