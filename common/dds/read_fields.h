// SPDX-License-Identifier: Apache-2.0
// Reads the fields of messages, as common/wire/message_fields.h lists them, from CDR. Internal.
#pragma once

#include <tuple>
#include <type_traits>

#include "common/base/one_line.h"
#include "common/dds/cdr_reader.h"
#include "common/wire/message_fields.h"

namespace shoal::dds {

class FieldReader {
 public:
  // Borrows the reader.
  explicit FieldReader(CdrReader* reader) : reader_(reader) {}

  template <HasFields M>
  void ReadAll(M* message) {
    std::apply([this](auto&&... field) { (this->Read(field), ...); }, FieldsOf(*message));
  }

 private:
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void Read(T& number) {
    if constexpr (std::is_same_v<T, bool>) {
      number = reader_->Read<uint8_t>() != 0;
    } else if constexpr (std::is_enum_v<T>) {
      number = static_cast<T>(reader_->Read<std::underlying_type_t<T>>());
    } else {
      number = reader_->Read<T>();
    }
  }
  void Read(std::string& text) { text = OneLine(reader_->ReadString()); }
  void Read(const LongText<std::string>& field) { field.text = reader_->ReadString(); }
  void Read(std::span<const uint8_t>& bytes) { bytes = reader_->ReadBytes(); }
  template <class T>
  requires std::is_arithmetic_v<T>
  void Read(std::vector<T>& values) { values = reader_->ReadNumbers<T>(); }
  void Read(std::vector<std::string>& texts) {
    texts = reader_->ReadStrings();
    for (std::string& text : texts) text = OneLine(text);
  }
  template <HasFields E>
  void Read(std::vector<E>& elements) {
    elements.clear();
    reader_->ReadCollection([&] {
      E& element = elements.emplace_back();
      reader_->ReadAppendable([&] { ReadAll(&element); });
    });
  }

  CdrReader* const reader_;
};

}  // namespace shoal::dds
