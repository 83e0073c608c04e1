// SPDX-License-Identifier: Apache-2.0
// A configuration key that was changed while a run went on.
#pragma once

#include <cstdint>
#include <string>

namespace shoal::launch {

// One change, as meta.json keeps it.
struct SettingChange {
  std::string time;  // UTC
  uint64_t env_steps = 0, updates = 0;
  std::string key;
  double from = 0, to = 0;
};

}  // namespace shoal::launch
