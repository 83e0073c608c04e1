// SPDX-License-Identifier: Apache-2.0
#include "launch/run/train_options.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/config/learner_threads.h"
#include "common/run_folder/run_file_names.h"
#include "learner/learner_device.h"

namespace shoal::launch {
namespace {

// The preset that a configuration file names.
struct FilePreset {
  std::string name;    // empty if the file names none
  bool whole = false;  // a resolved configuration, which contains every key of its preset
};

FilePreset PresetOfFile(const std::string& file) {
  if (file.empty()) return {};
  const nlohmann::json object = ParseStrictJson(ReadFile(file), file);
  if (!object.is_object() || !object.contains("preset") || !object["preset"].is_string()) return {};
  return {.name = object["preset"].get<std::string>(),
          .whole = object.contains("schema") && object["schema"] == kConfigSchema};
}

FilePreset ChoosePreset(const TrainOptions& options) {
  FilePreset of_file = PresetOfFile(options.config_file);
  if (!options.preset.empty() && !of_file.name.empty() && options.preset != of_file.name) {
    throw UsageError("--preset {}: {} is written for preset '{}'", options.preset,
                     options.config_file, of_file.name);
  }
  if (!options.preset.empty()) of_file.name = options.preset;
  return of_file;
}

// On a GPU, one thread submits the work.
int ThreadsOf(const Config& config, int cores) {
  if (config.learner.threads == 0 && learner::UsesGpu(config.learner)) return 1;
  return LearnerThreads(config, cores);
}

}  // namespace

Config GivenConfig(const TrainOptions& options, const EnvironmentDefaults& defaults) {
  auto [preset, whole] = ChoosePreset(options);
  if (preset.empty() && !whole) preset = defaults.preset;
  // A run's config.json holds every key, so its preset, which may have changed, is not applied.
  Config config;
  if (!whole) ApplyAssignments(defaults.assignments, &config);
  if (!preset.empty() && !whole) {
    ApplyFile(FindPreset(preset), &config);
    config.preset = preset;
  }
  if (!options.config_file.empty()) ApplyFile(options.config_file, &config);
  ApplyAssignments(options.set, &config);
  if (config.preset != preset) {
    throw UsageError("--set preset={}: a preset is chosen with --preset", config.preset);
  }
  if (!options.run_name.empty()) ApplyAssignments({"run_name=" + options.run_name}, &config);
  if (!options.run_dir.empty()) ApplyAssignments({"run_dir=" + options.run_dir}, &config);
  if (options.lockstep) config.lockstep = true;
  // Absolute paths: processes that start later may have another working directory.
  for (std::string* path : {&config.task_library, &config.model, &config.network.encoder_weights}) {
    if (!path->empty()) *path = std::filesystem::absolute(*path).lexically_normal();
  }
  CompleteEnvironmentKeys(&config);
  return config;
}

Config ResolveConfig(const TrainOptions& options, int cores, const EnvironmentDefaults& defaults) {
  Config config = GivenConfig(options, defaults);
  // Threads of one update wait for each other, so a core shared with an actor stalls them all.
  config.learner.threads = ThreadsOf(config, cores);
  if (config.actors == 0) {
    config.actors = config.lockstep ? 1 : std::max(1, cores - config.learner.threads);
  }
  Validate(config);
  return config;
}

bool SetsForMachine(const std::string& assignment) {
  return assignment.starts_with("learner.device=") ||
         assignment.starts_with("learner.precision=") ||
         assignment.starts_with("learner.threads=") || assignment.starts_with("replay.keep=");
}

void ApplyResumeOptions(const TrainOptions& options, int cores, Config* config) {
  const std::pair<bool, const char*> refused[] = {
      {!options.preset.empty(), "--preset"},       {!options.config_file.empty(), "--config"},
      {!options.run_name.empty(), "--run-name"},   {options.overwrite, "--overwrite"},
      {!options.init_from.empty(), "--init-from"}, {options.lockstep, "--lockstep"}};
  for (const auto& [given, name] : refused) {
    if (given)
      throw UsageError("--resume continues with the run's own configuration: expected no {}", name);
  }
  for (const std::string& assignment : options.set) {
    if (!assignment.starts_with("env_steps=") && !assignment.starts_with("stop.") &&
        !SetsForMachine(assignment)) {
      throw UsageError(
          "--set {}: a resumed run takes env_steps, stop.*, learner.device, learner.precision, "
          "learner.threads and replay.keep only",
          assignment);
    }
  }
  ApplyAssignments(options.set, config);
  config->learner.threads = ThreadsOf(*config, cores);
  Validate(*config);
}

}  // namespace shoal::launch
