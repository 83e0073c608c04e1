// SPDX-License-Identifier: Apache-2.0
#include "common/config/value_json.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace shoal::internal {
namespace {

using nlohmann::json;

bool ReadNumber(const json& value, double* number) {
  if (!value.is_number()) return false;
  *number = value.get<double>();
  return std::isfinite(*number);
}

bool ReadPoint(const json& value, std::array<double, 3>* point) {
  if (!value.is_array() || value.size() != point->size()) return false;
  for (size_t i = 0; i < point->size(); ++i) {
    if (!ReadNumber(value[i], &(*point)[i])) return false;
  }
  return true;
}

bool ReadCamera(const json& value, CustomCamera* camera) {
  const bool mounted = value.is_object() && value.contains("body");
  if (!value.is_object() || value.size() != (mounted ? 5 : 4)) return false;
  if (mounted) {
    if (!value["body"].is_string() || value["body"].empty()) return false;
    value["body"].get_to(camera->body);
    if (camera->body.empty()) return false;
  }
  for (const char* key : {"lookat", "distance", "azimuth", "elevation"}) {
    if (!value.contains(key)) return false;
  }
  return ReadPoint(value["lookat"], &camera->lookat) &&
         ReadNumber(value["distance"], &camera->distance) &&
         ReadNumber(value["azimuth"], &camera->azimuth) &&
         ReadNumber(value["elevation"], &camera->elevation) && camera->distance > 0 &&
         std::fabs(camera->elevation) <= 90;
}

}  // namespace

bool ReadStateBlocks(const json& value, StateBlocks* blocks) {
  if (value.is_boolean()) {
    *blocks = value.get<bool>();
    return true;
  }
  if (!value.is_array() || value.empty()) return false;
  std::vector<std::string> names;
  for (const json& name : value) {
    if (!name.is_string() || std::ranges::count(names, name.get<std::string>()) > 0) return false;
    names.push_back(name.get<std::string>());
  }
  *blocks = StateBlocks(std::move(names));
  return true;
}

bool ReadCustomCameras(const json& value, std::map<std::string, CustomCamera>* cameras) {
  if (!value.is_object()) return false;
  std::map<std::string, CustomCamera> read;
  for (const auto& [name, camera] : value.items()) {
    if (name.empty() || !ReadCamera(camera, &read[name])) return false;
  }
  *cameras = std::move(read);
  return true;
}

}  // namespace shoal::internal
