// SPDX-License-Identifier: Apache-2.0
// The configuration keys that may be changed while a run goes on: their present values, and what
// has been changed. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/config.h"
#include "common/wire/messages.h"
#include "launch/record/setting_change.h"

namespace shoal::launch {

// A process of `role` reports the value that it uses as `metric`.
struct SettingUse {
  std::string_view role, metric;
};
struct LiveKey {
  std::string_view key;
  std::span<const SettingUse> uses;
};

// Every key that may be changed; `actors` by `shoal scale` alone.
std::span<const LiveKey> LiveKeys();
// "env_steps, eval.interval, ...", for messages and help.
std::string LiveKeyNames();

class LiveSettings {
 public:
  // As config.json has them. In lockstep nothing may be changed.
  explicit LiveSettings(const Config& config) : config_(config) {}

  // "KEY=VALUE". Returns key, former and new value; of a schedule the former value is that at
  // `env_steps`, those of the run so far. Nothing has changed when it throws Error (kUsage): a key
  // that does not exist or is fixed for the run, a value that it does not take, a schedule (only
  // its numbers can be told to processes), lockstep.
  SettingChange Assign(const std::string& assignment, uint64_t env_steps);
  SettingChange SetActors(const std::string& count);
  // What was changed before the run was interrupted.
  void Restore(std::span<const SettingChange> changes);

  // With the present values.
  const Config& config() const { return config_; }
  // Adds the keys that were changed, with their present values.
  void AddTo(ControlMessage* message) const;

 private:
  SettingChange Apply(const std::string& key, const std::string& assignment, uint64_t env_steps);

  Config config_;
  std::vector<std::string> changed_;  // keys, each once
};

}  // namespace shoal::launch
