// SPDX-License-Identifier: Apache-2.0
// The configuration keys that may be changed during a run: their present values, and the changes.
// Pure.
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

// A process of `role` reports its present value of a key as `metric`.
struct SettingUse {
  std::string_view role, metric;
};
struct LiveKey {
  std::string_view key;
  std::span<const SettingUse> uses;
};

// All keys that may be changed. Only `shoal scale` changes `actors`.
std::span<const LiveKey> LiveKeys();
// "env_steps, eval.interval, ...", for messages and help.
std::string LiveKeyNames();

class LiveSettings {
 public:
  // `config`: the run's config.json. In lockstep no key may be changed.
  explicit LiveSettings(const Config& config) : config_(config) {}

  // Assigns "KEY=VALUE". Returns the key, its old and its new value. `env_steps`: the run's steps
  // so far; the old value of a schedule is its value at this step. Throws Error (kUsage), and
  // changes nothing, in lockstep, if the key does not exist or is fixed for the run, or if the
  // value is out of range or is a schedule (ControlMessage contains only numbers).
  SettingChange Assign(const std::string& assignment, uint64_t env_steps);
  SettingChange SetActors(const std::string& count);
  // Applies again the changes that were made before the run was interrupted.
  void Restore(std::span<const SettingChange> changes);

  // The run's configuration with the present values.
  const Config& config() const { return config_; }
  // Adds the keys that were changed, with their present values.
  void AddTo(ControlMessage* message) const;

 private:
  SettingChange Apply(const std::string& key, const std::string& assignment, uint64_t env_steps);

  Config config_;
  std::vector<std::string> changed_;  // keys, each once
};

}  // namespace shoal::launch
