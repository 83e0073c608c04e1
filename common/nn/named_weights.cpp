// SPDX-License-Identifier: Apache-2.0
#include "common/nn/named_weights.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"

namespace shoal::nn {
namespace {

// Appends the values to `tensor` along the first dimension.
void Stack(const NamedTensor& more, const std::string& name, const std::string& map_file,
           NamedTensor* tensor) {
  const auto rest = [](const NamedTensor& t) {
    return std::vector<int64_t>(t.shape.begin() + 1, t.shape.end());
  };
  if (tensor->shape.empty() || more.shape.empty() || tensor->dtype != more.dtype ||
      rest(*tensor) != rest(more)) {
    throw UsageError(
        "{}: the tensors of {} do not go together: expected one type and shapes that "
        "differ in the first dimension alone",
        map_file, name);
  }
  tensor->shape[0] += more.shape[0];
  tensor->data.insert(tensor->data.end(), more.data.begin(), more.data.end());
}

// The names in the file to which one of Shoal's names is mapped.
std::vector<std::string> Sources(const std::string& name, const nlohmann::json& value,
                                 const std::string& map_file) {
  if (value.is_string()) return {value.get<std::string>()};
  std::vector<std::string> names;
  for (const nlohmann::json& part : value.is_array() ? value : nlohmann::json::array()) {
    if (part.is_string()) names.push_back(part.get<std::string>());
  }
  if (names.empty() || names.size() != value.size()) {
    throw UsageError("{}: {}: expected a tensor's name or a list of names", map_file, name);
  }
  return names;
}

}  // namespace

TensorMap ReadNamedWeights(const std::string& file, const std::string& map_file) {
  TensorMap theirs;
  try {
    theirs = ReadSafetensors(ReadFile(file), file);
  } catch (const Error& error) {
    throw UsageError("{}", error.what());
  }
  if (map_file.empty()) return theirs;
  const nlohmann::json map = ParseStrictJson(ReadFile(map_file), map_file);
  if (!map.is_object()) throw UsageError("{}: expected a JSON object", map_file);
  TensorMap ours;
  for (const auto& [name, value] : map.items()) {
    for (const std::string& source : Sources(name, value, map_file)) {
      const auto at = theirs.find(source);
      if (at == theirs.end()) throw UsageError("{}: tensor {} is missing", file, source);
      const auto [own, fresh] = ours.try_emplace(name, at->second);
      if (!fresh) Stack(at->second, name, map_file, &own->second);
    }
  }
  return ours;
}

}  // namespace shoal::nn
