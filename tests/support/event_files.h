// What TensorBoard would read from a folder of event files.
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

// By name, and so by the second in which they were made.
inline std::vector<std::filesystem::path> EventFiles(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

using Scalars = std::map<std::string, std::vector<std::pair<int64_t, float>>>;  // tag -> (x, y)

// Of one file, whose framing must be whole; the checksums are tf_record_test's matter.
inline Scalars ReadScalars(const std::filesystem::path& path) {
  const std::string file = ReadFile(path);
  Scalars scalars;
  for (size_t at = 0; at < file.size();) {
    uint64_t length = 0;
    std::memcpy(&length, file.data() + at, std::min<size_t>(8, file.size() - at));
    tensorboard::proto::Event event;
    if (at + 16 + length > file.size() || !event.ParseFromString(file.substr(at + 12, length))) {
      ADD_FAILURE() << path << ": broken at byte " << at;
      break;
    }
    for (const auto& value : event.summary().value()) {
      scalars[value.tag()].push_back({event.step(), value.simple_value()});
    }
    at += 16 + length;
  }
  return scalars;
}

}  // namespace shoal
