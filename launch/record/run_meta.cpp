// SPDX-License-Identifier: Apache-2.0
#include "launch/record/run_meta.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/or_null.h"
#include "common/config/config_io.h"
#include "common/nn/precision.h"
#include "common/run_folder/learner_device_file.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/json_fields.h"
#include "launch/record/machine.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

ordered_json FirstSuccess(const RunMeta& meta) {
  if (!meta.first_success) return nullptr;
  return {{"target", meta.target},
          {"env_steps", meta.first_success->env_steps},
          {"updates", meta.first_success->updates},
          {"wall_seconds", meta.first_success->wall_seconds}};
}

ordered_json Best(const RunMeta& meta) {
  if (!meta.best) return nullptr;
  return {{"checkpoint", meta.best->checkpoint},
          {"env_steps", meta.best->env_steps},
          {"updates", meta.best->updates},
          {"success_rate", OrNull(meta.best->success)},
          {"return_mean", meta.best->mean_return}};
}

// The commits of the run so far and that of this build.
std::vector<std::string> Commits(const RunMeta& meta) {
  std::vector<std::string> commits = meta.commits;
  if (std::ranges::find(commits, BuildCommit()) == commits.end()) {
    commits.emplace_back(BuildCommit());
  }
  return commits;
}

ordered_json UpdatesPerEnvStep(const RunMeta& meta) {
  if (meta.env_steps == 0) return nullptr;
  return static_cast<double>(meta.updates) / static_cast<double>(meta.env_steps);
}

ordered_json Changes(const RunMeta& meta) {
  ordered_json list = ordered_json::array();
  for (const SettingChange& change : meta.changes) {
    list.push_back({{"time", change.time},
                    {"env_steps", change.env_steps},
                    {"updates", change.updates},
                    {"key", change.key},
                    {"from", change.from},
                    {"to", change.to}});
  }
  return list;
}

SettingChange ReadChange(const nlohmann::json& object) {
  SettingChange change;
  object.at("time").get_to(change.time);
  object.at("env_steps").get_to(change.env_steps);
  object.at("updates").get_to(change.updates);
  object.at("key").get_to(change.key);
  object.at("from").get_to(change.from);
  object.at("to").get_to(change.to);
  return change;
}

ordered_json Versions() {
  return {{"shoal", BuildVersion()},
          {"compiler", __VERSION__},
          {"mujoco", SHOAL_MUJOCO_VERSION},
          {"cyclonedds", SHOAL_CYCLONEDDS_VERSION},
          {"onednn", SHOAL_ONEDNN_VERSION}};
}

// The learner's record; nullopt on a CPU without a choice, before the learner has started, or if
// the file is damaged.
std::optional<LearnerDeviceRecord> DeviceOf(const std::filesystem::path& run) {
  try {
    return ReadLearnerDevice(run);
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::string Precision(const Config& config, const std::optional<LearnerDeviceRecord>& device) {
  if (device) return device->precision;
  const auto choose =
      config.learner.device == "cuda" ? nn::ChooseGpuPrecision : nn::ChoosePrecision;
  return nn::ToString(choose(config.learner.precision, config.observation.pixels));
}

ordered_json LearnerDevice(const std::optional<LearnerDeviceRecord>& device) {
  if (!device || device->device == "cpu") {
    const bool chosen = device && !device->reason.empty();
    return {{"device", "cpu"}, {"reason", chosen ? ordered_json(device->reason) : nullptr}};
  }
  return {{"device", device->device},
          {"card", device->card},
          {"driver", device->driver},
          {"memory_gb", std::round(static_cast<double>(device->memory_bytes) / 1e8) / 10},
          {"losses", device->losses}};
}

}  // namespace

void WriteRunMeta(const std::filesystem::path& run, const Config& config, const RunMeta& meta) {
  const std::optional<LearnerDeviceRecord> device = DeviceOf(run);
  const ordered_json object{
      {"schema", kMetaSchema},
      {"name", config.run_name},
      {"task", config.task},
      {"preset", config.preset},
      {"seed", config.seed},
      {"commit", BuildCommit()},
      {"commits", Commits(meta)},
      {"versions", Versions()},
      {"machine", DescribeMachine()},
      {"precision", Precision(config, device)},
      {"learner_device", LearnerDevice(device)},
      {"policy_inputs", ToJson(meta.policy_inputs)},
      {"privileged_inputs", ToJson(meta.privileged_inputs)},
      {"started", meta.started},
      {"finished", meta.finished.empty() ? ordered_json(nullptr) : ordered_json(meta.finished)},
      {"env_steps", meta.env_steps},
      {"updates", meta.updates},
      {"updates_per_env_step", UpdatesPerEnvStep(meta)},
      {"updates_lost", meta.updates_lost},
      {"wall_seconds", meta.wall_seconds},
      {"cpu_seconds", OrNull(meta.cpu_seconds)},
      {"energy_wh", OrNull(meta.energy_wh)},
      {"first_success", FirstSuccess(meta)},
      {"best", Best(meta)},
      {"final_success_rate", OrNull(meta.final_success)},
      {"final_return_mean", OrNull(meta.final_return)},
      {"accounting", meta.accounting ? ToJson(*meta.accounting) : ordered_json(nullptr)},
      {"changes", Changes(meta)},
      {"restarts", meta.restarts},
      {"resends", meta.resends},
      {"faulty_episodes", ordered_json(meta.faulty_episodes)},
      {"exit", meta.exit},
      {"error", meta.error.empty() ? ordered_json(nullptr) : ordered_json(meta.error)}};
  // `error` may quote the last output of a process, which need not be UTF-8.
  const std::string text =
      object.dump(2, ' ', /*ensure_ascii=*/false, ordered_json::error_handler_t::replace);
  WriteFileAtomically(run / kMetaFile, text + "\n");
}

RunMeta ReadRunMeta(const std::filesystem::path& run) {
  const std::filesystem::path path = run / kMetaFile;
  RunMeta meta;
  if (!std::filesystem::exists(path)) return meta;
  const nlohmann::json object = ParseStrictJson(ReadFile(path), path);
  try {
    if (object.contains("commits")) {
      object.at("commits").get_to(meta.commits);
    } else if (object.contains("commit")) {  // older builds wrote the last commit only
      meta.commits = {object.at("commit").get<std::string>()};
    }
    object.at("started").get_to(meta.started);
    object.at("wall_seconds").get_to(meta.wall_seconds);
    object.at("env_steps").get_to(meta.env_steps);
    object.at("updates").get_to(meta.updates);
    object.at("restarts").get_to(meta.restarts);
    meta.cpu_seconds = NumberOrNothing(object, "cpu_seconds");
    meta.energy_wh = NumberOrNothing(object, "energy_wh");
    meta.resends = object.value("resends", uint64_t{0});
    meta.updates_lost = object.value("updates_lost", uint64_t{0});
    meta.faulty_episodes = object.value("faulty_episodes", meta.faulty_episodes);
    meta.exit = object.value("exit", meta.exit);
    meta.final_return = NumberOrNothing(object, "final_return_mean");
    for (const auto& change : object.value("changes", nlohmann::json::array())) {
      meta.changes.push_back(ReadChange(change));
    }
  } catch (const nlohmann::json::exception& e) {
    throw RuntimeError("{}: {}", path.string(), e.what());
  }
  return meta;
}

std::string FormatFirstSuccess(const RunMeta& meta, int evaluations) {
  const double percent = 100 * meta.target;
  if (!meta.first_success) {
    if (!meta.best || !meta.best->success) return "";
    return fmt::format(
        "while training: no {} evaluations in a row had success >= {:.0f} % together", evaluations,
        percent);
  }
  const EvaluationPoint& first = *meta.first_success;
  std::string line = fmt::format(
      "while training: success >= {:.0f} % over {} evaluations in a row, first from {} env steps, "
      "{} "
      "updates, {:.0f} s on",
      percent, evaluations, first.env_steps, first.updates, first.wall_seconds);
  if (meta.final_success && *meta.final_success < meta.target) {
    line += fmt::format("; the final evaluation, of other episodes, is below that: {:.1f} %",
                        100 * *meta.final_success);
  }
  return line;
}

}  // namespace shoal::launch
