// SPDX-License-Identifier: Apache-2.0
// Strict reader of JSON files with measurements. Errors name the keys that lead to a missing or
// ill-typed value.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/base/error.h"

namespace shoal::worlds {

// Reads a file. Throws Error if the file cannot be read or is not JSON.
nlohmann::json ReadJson(const std::filesystem::path& path);

// Reader of one JSON object of a file. Borrows object and file name. All functions throw Error
// naming the file and the key.
class MeasurementReader {
 public:
  MeasurementReader(const std::filesystem::path& file, const nlohmann::json& object,
                    std::string where);

  Error Fault(const std::string& what, const std::string& problem) const;
  // Path of a key for messages: "reset.obs" for the key "obs" of the object at "reset".
  std::string Path(const std::string& key) const;

  bool Has(const std::string& key) const { return object_.contains(key); }
  const nlohmann::json& object() const { return object_; }
  const nlohmann::json& At(const std::string& key) const;
  MeasurementReader Object(const std::string& key) const;
  std::string Text(const std::string& key) const;
  double Number(const std::string& key) const;
  std::vector<double> Numbers(const std::string& key, size_t size) const;
  std::vector<std::string> Names(const std::string& key) const;

  template <size_t kSize>
  std::array<double, kSize> Numbers(const std::string& key) const {
    std::array<double, kSize> numbers{};
    std::ranges::copy(Numbers(key, kSize), numbers.begin());
    return numbers;
  }

 private:
  const std::filesystem::path& file_;
  const nlohmann::json& object_;
  std::string where_;
};

}  // namespace shoal::worlds
