// SPDX-License-Identifier: Apache-2.0
#include "launch/run/live_settings.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/config/config_io.h"
#include "common/config/learner_threads.h"
#include "common/config/on_policy.h"

namespace shoal::launch {
namespace {

constexpr SettingUse kActors[] = {{"coordinator", "actors"}};
constexpr SettingUse kBudget[] = {{"coordinator", "budget_env_steps"},
                                  {"replay", "budget_env_steps"},
                                  {"learner", "budget_env_steps"}};
constexpr SettingUse kInterval[] = {{"learner", "eval_interval"}};
constexpr SettingUse kThreads[] = {{"learner", "threads"}};
constexpr SettingUse kPeriod[] = {{"learner", "weights_period"}};
constexpr SettingUse kRatio[] = {{"replay", "limiter_samples_per_insert"},
                                 {"learner", "samples_per_insert"}};
constexpr SettingUse kEvaluations[] = {{"coordinator", "stop_evaluations"}};
constexpr SettingUse kSuccess[] = {{"coordinator", "stop_success"}};

constexpr std::string_view kActorsKey = "actors", kThreadsKey = "learner.threads";
constexpr LiveKey kKeys[] = {{kActorsKey, kActors},
                             {"env_steps", kBudget},
                             {"eval.interval", kInterval},
                             {kThreadsKey, kThreads},
                             {"learner.weights_period", kPeriod},
                             {"replay.samples_per_insert", kRatio},
                             {"stop.evaluations", kEvaluations},
                             {"stop.success", kSuccess}};

bool IsLive(std::string_view key) {
  return std::ranges::find(kKeys, key, &LiveKey::key) != std::end(kKeys);
}

// Throws Error if a running learner cannot change to this number of threads.
void CheckThreads(const Config& config) {
  if (LearnsOnPolicy(config)) {
    throw UsageError("learner.threads is fixed for the run: {} learns on policy",
                     config.learner.algorithm);
  }
  if (config.learner.threads == 0) {
    throw UsageError("learner.threads=0: expected at least 1 in a running run");
  }
  CheckReplicas(config, config.learner.threads);
}

// The key's value: a number, or a schedule as text.
nlohmann::ordered_json JsonOf(const Config& config, std::string key) {
  std::ranges::replace(key, '.', '/');
  return ToJson(config).at(nlohmann::ordered_json::json_pointer("/" + key));
}

// The value of the key after this number of env steps.
double ValueOf(const Config& config, const std::string& key, uint64_t env_steps) {
  const nlohmann::ordered_json value = JsonOf(config, key);
  if (!value.is_string()) return value.get<double>();
  const std::optional<Schedule> schedule = ParseSchedule(value.get<std::string>());
  CHECK(schedule) << key;
  return schedule->At(env_steps);
}

}  // namespace

std::span<const LiveKey> LiveKeys() { return kKeys; }

std::string LiveKeyNames() {
  std::string names;
  for (const LiveKey& live : kKeys) {
    if (live.key == kActorsKey) continue;
    names += (names.empty() ? "" : ", ") + std::string(live.key);
  }
  return names;
}

SettingChange LiveSettings::Assign(const std::string& assignment, uint64_t env_steps) {
  const std::string key = assignment.substr(0, assignment.find('='));
  if (key == kActorsKey) throw UsageError("{}: use shoal scale N", assignment);
  return Apply(key, assignment, env_steps);
}

SettingChange LiveSettings::SetActors(const std::string& count) {
  if (count == "0") throw UsageError("actors=0: a run needs at least one actor");
  return Apply(std::string(kActorsKey), fmt::format("{}={}", kActorsKey, count), 0);
}

SettingChange LiveSettings::Apply(const std::string& key, const std::string& assignment,
                                  uint64_t env_steps) {
  Config changed = config_;
  ApplyAssignments({assignment}, &changed);  // throws for unknown keys and invalid values
  if (!IsLive(key)) {
    throw UsageError("{} is fixed for the run; what can be changed: {}", key, LiveKeyNames());
  }
  if (config_.lockstep) {
    throw UsageError("{}: a lockstep run repeats bit for bit, so nothing of it can be changed",
                     key);
  }
  Validate(changed);
  if (key == kThreadsKey) CheckThreads(changed);
  if (JsonOf(changed, key).is_string()) {
    throw UsageError("{}: expected a number; a running run accepts no schedule", assignment);
  }
  SettingChange change;
  change.key = key;
  change.from = ValueOf(config_, key, env_steps);
  change.to = ValueOf(changed, key, env_steps);
  config_ = changed;
  if (std::ranges::find(changed_, key) == changed_.end()) changed_.push_back(key);
  return change;
}

void LiveSettings::Restore(std::span<const SettingChange> changes) {
  for (const SettingChange& change : changes) {
    Apply(change.key, fmt::format("{}={}", change.key, change.to), change.env_steps);
  }
}

void LiveSettings::AddTo(ControlMessage* message) const {
  message->setting_names = changed_;
  message->setting_values.clear();
  for (const std::string& key : changed_) {
    message->setting_values.push_back(JsonOf(config_, key).get<double>());
  }
}

}  // namespace shoal::launch
