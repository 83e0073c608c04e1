// SPDX-License-Identifier: Apache-2.0
// Reads a folder of event files like TensorBoard.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/base/files.h"
#include "common/tensorboard/event.pb.h"

namespace shoal {

// The files sorted by name, which begins with the time of creation in seconds.
inline std::vector<std::filesystem::path> EventFiles(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

// Events of one file. Fails the test if the file ends within an event. tf_record_test tests the
// checksums.
inline std::vector<tensorboard::proto::Event> ReadEvents(const std::filesystem::path& path) {
  const std::string file = ReadFile(path);
  std::vector<tensorboard::proto::Event> events;
  for (size_t at = 0; at < file.size();) {
    uint64_t length = 0;
    std::memcpy(&length, file.data() + at, std::min<size_t>(8, file.size() - at));
    tensorboard::proto::Event event;
    if (at + 16 + length > file.size() || !event.ParseFromString(file.substr(at + 12, length))) {
      ADD_FAILURE() << path << ": broken at byte " << at;
      break;
    }
    events.push_back(event);
    at += 16 + length;
  }
  return events;
}

using Scalars = std::map<std::string, std::vector<std::pair<int64_t, float>>>;  // tag -> (x, y)

inline Scalars ReadScalars(const std::filesystem::path& path) {
  Scalars scalars;
  for (const auto& event : ReadEvents(path)) {
    for (const auto& value : event.summary().value()) {
      if (value.has_metadata()) continue;  // data of a plugin
      scalars[value.tag()].push_back({event.step(), value.simple_value()});
    }
  }
  return scalars;
}

// Values for TensorBoard's plugins, by tag.
inline std::map<std::string, tensorboard::proto::Summary::Value> ReadPluginValues(
    const std::filesystem::path& path) {
  std::map<std::string, tensorboard::proto::Summary::Value> values;
  for (const auto& event : ReadEvents(path)) {
    for (const auto& value : event.summary().value()) {
      if (value.has_metadata()) values[value.tag()] = value;
    }
  }
  return values;
}

}  // namespace shoal
