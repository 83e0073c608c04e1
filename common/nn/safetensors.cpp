// SPDX-License-Identifier: Apache-2.0
#include "common/nn/safetensors.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "common/base/bounded_json.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/nn/bf16.h"
#include "common/nn/network_plan.h"

namespace shoal::nn {
namespace {

using nlohmann::json;

constexpr uint64_t kLengthBytes = 8;
constexpr uint64_t kMaxHeaderBytes = 100'000'000;
constexpr uint64_t kHeaderAlignment = 8;  // of the data; spaces pad the header
constexpr const char* kMetadata = "__metadata__";

// Bytes per element; 0 for a type this project does not use.
uint64_t ElementBytes(const std::string& dtype) {
  if (dtype == "F32") return 4;
  if (dtype == "BF16") return 2;
  if (dtype == "U8") return 1;
  if (dtype == "U64" || dtype == "I64") return 8;
  return 0;
}

// The text's JSON value. nlohmann's parser keeps the last of two equal keys; here equal keys are an
// error.
json ParseHeader(std::string_view text, const std::string& source) {
  std::vector<std::set<std::string>> keys;  // one set per open object
  std::string duplicate;
  const json::parser_callback_t watch = [&](int, json::parse_event_t event, json& value) {
    if (event == json::parse_event_t::object_start) keys.emplace_back();
    if (event == json::parse_event_t::object_end) keys.pop_back();
    if (event == json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second) {
      duplicate = value.get<std::string>();
    }
    return true;
  };
  if (JsonTooDeep(text)) {
    throw RuntimeError("{}: the safetensors header is nested too deep", source);
  }
  json header = json::parse(text.begin(), text.end(), watch, /*allow_exceptions=*/false);
  if (header.is_discarded() || !header.is_object()) {
    throw RuntimeError("{}: the safetensors header is not a JSON object", source);
  }
  if (!duplicate.empty()) throw RuntimeError("{}: {} is there twice", source, duplicate);
  return header;
}

struct Entry {
  std::string name;
  TensorView tensor;  // without data
  uint64_t begin = 0, end = 0;
};

// Product of the shape and the element's size. Throws Error if the product does not fit 63 bits.
uint64_t TensorBytes(const std::string& dtype, const std::vector<int64_t>& shape,
                     const std::string& name, const std::string& source) {
  constexpr uint64_t kLimit = uint64_t(std::numeric_limits<int64_t>::max());
  uint64_t bytes = ElementBytes(dtype);
  for (const int64_t size : shape) {
    if (size != 0 && bytes > kLimit / uint64_t(size)) {
      throw RuntimeError("{}: tensor {} is too large", source, name);
    }
    bytes *= uint64_t(size);
  }
  return bytes;
}

Entry ParseEntry(const std::string& name, const json& value, const std::string& source) {
  const auto fault = [&](const char* what) {
    return RuntimeError("{}: tensor {}: {}", source, name, what);
  };
  if (!value.is_object() || value.size() != 3 || !value.contains("dtype") ||
      !value.contains("shape") || !value.contains("data_offsets")) {
    throw fault("expected dtype, shape and data_offsets");
  }
  const json &dtype = value["dtype"], &shape = value["shape"], &offsets = value["data_offsets"];
  if (!dtype.is_string() || ElementBytes(dtype.get<std::string>()) == 0) {
    throw fault("expected dtype F32, BF16, U8, U64 or I64");
  }
  Entry entry{name, {dtype.get<std::string>(), {}, {}}, 0, 0};
  if (!shape.is_array()) throw fault("shape is not an array");
  for (const json& size : shape) {
    if (!size.is_number_unsigned() || size.get<uint64_t>() > uint64_t(INT64_MAX)) {
      throw fault("shape holds something else than sizes");
    }
    entry.tensor.shape.push_back(size.get<int64_t>());
  }
  if (!offsets.is_array() || offsets.size() != 2 || !offsets[0].is_number_unsigned() ||
      !offsets[1].is_number_unsigned()) {
    throw fault("data_offsets are not two offsets");
  }
  entry.begin = offsets[0].get<uint64_t>();
  entry.end = offsets[1].get<uint64_t>();
  if (entry.begin > entry.end ||
      entry.end - entry.begin !=
          TensorBytes(entry.tensor.dtype, entry.tensor.shape, name, source)) {
    throw fault("data_offsets do not fit the shape");
  }
  return entry;
}

void CheckMetadata(const json& metadata, const std::string& source) {
  bool strings = metadata.is_object();
  for (const auto& [key, value] : metadata.items()) strings = strings && value.is_string();
  if (!strings) throw RuntimeError("{}: __metadata__ is not an object of strings", source);
}

// Requires that tensors fill `data_bytes` from the first to the last byte, without overlap.
void CheckCover(std::vector<Entry>* entries, uint64_t data_bytes, const std::string& source) {
  std::sort(entries->begin(), entries->end(), [](const Entry& a, const Entry& b) {
    return std::pair(a.begin, a.end) < std::pair(b.begin, b.end);
  });
  uint64_t expected = 0;
  for (const Entry& entry : *entries) {
    if (entry.begin != expected) {
      throw RuntimeError("{}: tensor {} begins at byte {}, expected {}", source, entry.name,
                         entry.begin, expected);
    }
    expected = entry.end;
  }
  if (expected != data_bytes) {
    throw RuntimeError("{}: {} bytes of data, expected {}", source, data_bytes, expected);
  }
}

// Rounds floats to half as many bytes in the same memory: fresh pages would cost more than the
// rounding.
void RoundInPlace(std::vector<uint8_t>* data) {
  constexpr size_t kFloatsAtOnce = 4096;
  uint16_t rounded[kFloatsAtOnce];
  const size_t count = data->size() / sizeof(float);
  for (size_t first = 0; first < count; first += kFloatsAtOnce) {
    const size_t n = std::min(kFloatsAtOnce, count - first);
    FloatsToBf16(reinterpret_cast<const float*>(data->data()) + first, int64_t(n), rounded);
    std::memcpy(data->data() + first * sizeof(uint16_t), rounded, n * sizeof(uint16_t));
  }
  data->resize(count * sizeof(uint16_t));
}

}  // namespace

TensorViews::TensorViews(const TensorMap& tensors) {
  for (const auto& [name, tensor] : tensors) {
    views_.emplace(name, TensorView{tensor.dtype, tensor.shape, tensor.data});
  }
}

const TensorView* TensorViews::Find(const std::string& name) const {
  const auto found = views_.find(name);
  return found == views_.end() ? nullptr : &found->second;
}

std::string WriteSafetensors(const TensorMap& tensors,
                             const std::map<std::string, std::string>& metadata) {
  json header = json::object();
  if (!metadata.empty()) header[kMetadata] = metadata;
  uint64_t offset = 0;
  for (const auto& [name, tensor] : tensors) {
    CHECK(ElementBytes(tensor.dtype) > 0) << name << " has dtype " << tensor.dtype;
    CHECK(TensorBytes(tensor.dtype, tensor.shape, name, "writer") == tensor.data.size())
        << name << " has " << tensor.data.size() << " bytes";
    const uint64_t end = offset + tensor.data.size();
    header[name] = {
        {"dtype", tensor.dtype}, {"shape", tensor.shape}, {"data_offsets", {offset, end}}};
    offset = end;
  }
  std::string text = header.dump();
  text.append((kHeaderAlignment - text.size() % kHeaderAlignment) % kHeaderAlignment, ' ');
  const uint64_t length = text.size();
  std::string file(kLengthBytes, '\0');
  std::memcpy(file.data(), &length, sizeof(length));
  file.reserve(kLengthBytes + length + offset);
  file += text;
  for (const auto& [name, tensor] : tensors) {
    file.append(reinterpret_cast<const char*>(tensor.data.data()), tensor.data.size());
  }
  return file;
}

TensorMap ReadSafetensors(std::string_view bytes, const std::string& source) {
  const TensorViews views = ReadSafetensorsViews(bytes, source);
  TensorMap tensors;
  for (const auto& [name, view] : views.all()) {
    tensors[name] = {view.dtype, view.shape, {view.data.begin(), view.data.end()}};
  }
  return tensors;
}

TensorViews ReadSafetensorsViews(std::string_view bytes, const std::string& source) {
  if (bytes.size() < kLengthBytes) {
    throw RuntimeError("{}: {} bytes, too short for a safetensors file", source, bytes.size());
  }
  uint64_t length = 0;
  std::memcpy(&length, bytes.data(), sizeof(length));
  if (length > kMaxHeaderBytes || length > bytes.size() - kLengthBytes) {
    throw RuntimeError("{}: safetensors header of {} bytes in a file of {}", source, length,
                       bytes.size());
  }
  const json header = ParseHeader(bytes.substr(kLengthBytes, length), source);
  const std::string_view data = bytes.substr(kLengthBytes + length);
  const auto* first = reinterpret_cast<const uint8_t*>(data.data());
  std::vector<Entry> entries;
  for (const auto& [name, value] : header.items()) {
    if (name == kMetadata) {
      CheckMetadata(value, source);
    } else {
      entries.push_back(ParseEntry(name, value, source));
    }
  }
  CheckCover(&entries, data.size(), source);
  TensorViews tensors;
  for (Entry& entry : entries) {
    entry.tensor.data = {first + entry.begin, first + entry.end};
    tensors.views_.emplace(std::move(entry.name), std::move(entry.tensor));
  }
  return tensors;
}

TensorMap ToBf16(TensorMap tensors) {
  for (auto& [name, tensor] : tensors) {
    const bool statistic = name.ends_with(kRunningMean) || name.ends_with(kRunningVariance) ||
                           name.starts_with("observation.");
    if (tensor.dtype != "F32" || statistic) continue;
    RoundInPlace(&tensor.data);
    tensor.dtype = "BF16";
  }
  return tensors;
}

}  // namespace shoal::nn
