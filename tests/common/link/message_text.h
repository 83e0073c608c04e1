// SPDX-License-Identifier: Apache-2.0
// Messages as text with every field, for tests that compare sent and received messages.
#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "common/base/random.h"
#include "common/wire/message_fields.h"

namespace shoal {

// Size and hash of a payload.
inline std::string Bytes(std::span<const uint8_t> payload) {
  return fmt::format("{}:{:x}", payload.size(), HashBytes(payload.data(), payload.size()));
}

template <HasFields M>
std::string Describe(const M& message);

template <class T>
requires std::is_arithmetic_v<T> std::string FieldText(T number) {
  return fmt::format("{}", number);
}
inline std::string FieldText(RunState state) { return FieldText(static_cast<uint32_t>(state)); }
inline std::string FieldText(const std::string& text) { return text; }
inline std::string FieldText(const LongText<const std::string>& field) { return field.text; }
inline std::string FieldText(std::span<const uint8_t> payload) { return Bytes(payload); }
template <HasFields E>
std::string FieldText(const E& element) {
  return "(" + Describe(element) + ")";
}
template <class E>
std::string FieldText(const std::vector<E>& elements) {
  std::string text = "[";
  for (const E& element : elements) text += FieldText(element) + ",";
  return text + "]";
}

// The message as one line; payloads are written as size and hash.
template <HasFields M>
std::string Describe(const M& message) {
  std::string text;
  std::apply([&](const auto&... field) { ((text += FieldText(field) + " "), ...); },
             FieldsOf(message));
  return text;
}

}  // namespace shoal
