// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/engine_messages.h"

#include <mujoco/mujoco.h>

#include <atomic>
#include <map>
#include <mutex>
#include <string>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/mutex.h"

namespace shoal::worlds {
namespace {

std::atomic<int64_t> warnings{0};

[[noreturn]] void ThrowEngineError(const char* message) {
  throw RuntimeError("MuJoCo: {}", message);
}

void CountWarning(const char* message) {
  ++warnings;
  // There is one text for each kind of warning and place, so the map stays small. Its size is
  // bounded nevertheless.
  constexpr size_t kMostTexts = 256;
  static Mutex mutex;
  static std::map<std::string, int64_t> counts;
  int64_t count = 0;
  {
    const MutexLock lock(mutex);
    if (counts.size() >= kMostTexts && counts.count(message) == 0) return;
    count = ++counts[message];
  }
  if ((count & (count - 1)) == 0) log::Warning("MuJoCo: {} (time {})", message, count);
}

}  // namespace

void InstallEngineCallbacks() {
  static std::once_flag once;
  std::call_once(once, [] {
    mju_user_error = ThrowEngineError;
    mju_user_warning = CountWarning;
  });
}

int64_t EngineWarnings() { return warnings; }

}  // namespace shoal::worlds
