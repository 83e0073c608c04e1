// SPDX-License-Identifier: Apache-2.0
// A configuration key that was changed during a run.
#pragma once

#include <cstdint>
#include <string>

namespace shoal::launch {

// One change, as stored in meta.json.
struct SettingChange {
  std::string time;  // UTC
  uint64_t env_steps = 0, updates = 0;
  std::string key;
  double from = 0, to = 0;
};

}  // namespace shoal::launch
