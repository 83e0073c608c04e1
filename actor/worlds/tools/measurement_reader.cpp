// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/measurement_reader.h"

#include <cmath>
#include <utility>

#include "common/base/bounded_json.h"
#include "common/base/files.h"

namespace shoal::worlds {
namespace {

using nlohmann::json;

bool IsFiniteNumber(const json& value) {
  return value.is_number() && std::isfinite(value.get<double>());
}

}  // namespace

json ReadJson(const std::filesystem::path& path) {
  json document = ParseBoundedJson<json>(ReadFile(path));
  if (document.is_discarded()) {
    throw RuntimeError("file '{}' is not JSON, or nested more than {} deep", path.string(),
                       kMaxJsonDepth);
  }
  return document;
}

MeasurementReader::MeasurementReader(const std::filesystem::path& file, const json& object,
                                     std::string where)
    : file_(file), object_(object), where_(std::move(where)) {
  if (!object.is_object()) throw Fault(where_.empty() ? "the file" : where_, "is not an object");
}

Error MeasurementReader::Fault(const std::string& what, const std::string& problem) const {
  return RuntimeError("reference file '{}': {} {}", file_.string(), what, problem);
}

std::string MeasurementReader::Path(const std::string& key) const {
  return where_.empty() ? key : where_ + "." + key;
}

const json& MeasurementReader::At(const std::string& key) const {
  const auto found = object_.find(key);
  if (found == object_.end()) throw Fault("key '" + Path(key) + "'", "is missing");
  return *found;
}

MeasurementReader MeasurementReader::Object(const std::string& key) const {
  return MeasurementReader(file_, At(key), Path(key));
}

std::string MeasurementReader::Text(const std::string& key) const {
  const json& value = At(key);
  if (!value.is_string()) throw Fault("key '" + Path(key) + "'", "is not a string");
  return value.get<std::string>();
}

double MeasurementReader::Number(const std::string& key) const {
  const json& value = At(key);
  if (!IsFiniteNumber(value)) throw Fault("key '" + Path(key) + "'", "is not a finite number");
  return value.get<double>();
}

std::vector<double> MeasurementReader::Numbers(const std::string& key, size_t size) const {
  const json& value = At(key);
  const bool good = value.is_array() && value.size() == size &&
                    std::all_of(value.begin(), value.end(), IsFiniteNumber);
  if (!good) {
    throw Fault("key '" + Path(key) + "'", fmt::format("is not {} finite numbers", size));
  }
  return value.get<std::vector<double>>();
}

std::vector<std::string> MeasurementReader::Names(const std::string& key) const {
  const json& value = At(key);
  const bool good = value.is_array() && !value.empty() &&
                    std::all_of(value.begin(), value.end(),
                                [](const json& element) { return element.is_string(); });
  if (!good) throw Fault("key '" + Path(key) + "'", "is not a list of names");
  return value.get<std::vector<std::string>>();
}

}  // namespace shoal::worlds
