#include "launch/train_options.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"

namespace shoal::launch {
namespace {

// The preset a configuration file names; empty when it names none.
std::string PresetOfFile(const std::string& file) {
  if (file.empty()) return "";
  const nlohmann::json object = ParseStrictJson(ReadFile(file), file);
  if (!object.is_object() || !object.contains("preset") || !object["preset"].is_string()) return "";
  return object["preset"].get<std::string>();
}

std::string ChoosePreset(const TrainOptions& options) {
  const std::string of_file = PresetOfFile(options.config_file);
  if (!options.preset.empty() && !of_file.empty() && options.preset != of_file) {
    throw UsageError("--preset {}: {} is written for preset '{}'", options.preset,
                     options.config_file, of_file);
  }
  return options.preset.empty() ? of_file : options.preset;
}

}  // namespace

Config ResolveConfig(const TrainOptions& options, int cores) {
  const std::string preset = ChoosePreset(options);
  Config config = preset.empty() ? Config{} : LoadPreset(preset);
  if (!options.config_file.empty()) ApplyFile(options.config_file, &config);
  ApplyAssignments(options.set, &config);
  if (config.preset != preset) {
    throw UsageError("--set preset={}: a preset is chosen with --preset", config.preset);
  }
  if (!options.run_name.empty()) ApplyAssignments({"run_name=" + options.run_name}, &config);
  if (options.lockstep) config.lockstep = true;
  // Threads of one update wait for each other, so a core shared with an actor stalls them all.
  if (config.learner.threads == 0) config.learner.threads = std::max(1, cores / 2);
  if (config.actors == 0) {
    config.actors = config.lockstep ? 1 : std::max(1, cores - config.learner.threads);
  }
  Validate(config);
  return config;
}

bool SetsPrecision(const std::string& assignment) {
  return assignment.starts_with("learner.precision=");
}

void ApplyResumeOptions(const TrainOptions& options, Config* config) {
  const std::pair<bool, const char*> refused[] = {{!options.preset.empty(), "--preset"},
                                                  {!options.config_file.empty(), "--config"},
                                                  {!options.run_name.empty(), "--run-name"},
                                                  {options.overwrite, "--overwrite"},
                                                  {options.lockstep, "--lockstep"}};
  for (const auto& [given, name] : refused) {
    if (given) throw UsageError("--resume goes on with the run's own configuration: no {}", name);
  }
  for (const std::string& assignment : options.set) {
    if (!assignment.starts_with("env_steps=") && !assignment.starts_with("stop.") &&
        !SetsPrecision(assignment)) {
      throw UsageError("--set {}: a resumed run takes env_steps, stop.* and learner.precision only",
                       assignment);
    }
  }
  ApplyAssignments(options.set, config);
  Validate(*config);
}

}  // namespace shoal::launch
