// SPDX-License-Identifier: Apache-2.0
#include "common/tensorboard/last_steps.h"

#include <algorithm>
#include <cstring>

#include "common/base/files.h"
#include "common/tensorboard/event.pb.h"

namespace shoal::tensorboard {
namespace {

// Frame of a record (tf_record.h): its length and a checksum before, a checksum after.
constexpr size_t kBefore = 12, kBehind = 4;

void AddSteps(const std::string& file, std::map<std::string, int64_t>* last) {
  size_t at = 0;
  while (file.size() - at >= kBefore + kBehind) {
    uint64_t length = 0;
    std::memcpy(&length, file.data() + at, sizeof length);
    if (length > file.size() - at - kBefore - kBehind) return;
    proto::Event event;
    if (!event.ParseFromArray(file.data() + at + kBefore, static_cast<int>(length))) return;
    for (const auto& value : event.summary().value()) {
      if (value.has_metadata()) continue;  // a plugin's value
      const auto [it, added] = last->try_emplace(value.tag(), event.step());
      it->second = std::max(it->second, event.step());
    }
    at += kBefore + length + kBehind;
  }
}

}  // namespace

std::map<std::string, int64_t> LastSteps(const std::filesystem::path& folder) {
  std::map<std::string, int64_t> last;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    if (it->path().filename().string().starts_with("events."))
      AddSteps(ReadFile(it->path()), &last);
  }
  return last;
}

}  // namespace shoal::tensorboard
