// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/experiment_folder.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <set>
#include <utility>

#include "common/base/bounded_json.h"
#include "common/base/build_info.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/actor_program.h"
#include "launch/run/environment_choice.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using std::chrono::milliseconds;

constexpr char kFolderSchema[] = "shoal-experiment-folder-1";
constexpr char kFile[] = "experiment.json";
constexpr char kLockFile[] = ".lock";
// Time that a task waits for the command that has submitted it.
constexpr std::chrono::seconds kSubmission{60};

// True if a command that was killed before it wrote experiment.json may have left the file.
bool IsLeftover(const fs::path& file) {
  const std::string name = file.filename();
  return name == kLockFile || name.starts_with(std::string(kFile) + ".tmp-");
}

bool HoldsOnlyLeftovers(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (!IsLeftover(it->path())) return false;
  }
  return true;
}

// The order of the keys does not matter.
bool SameKeys(const ordered_json& a, const ordered_json& b) {
  return nlohmann::json(a) == nlohmann::json(b);
}

// Describes the first forbidden change of a definition; empty if there is none.
std::string Difference(const Definition& stored, const Definition& asked) {
  if (asked.name != stored.name) {
    return fmt::format("its name is '{}', not '{}'", stored.name, asked.name);
  }
  if (asked.base != stored.base) {
    return fmt::format("its base is '{}', not '{}'", stored.base, asked.base);
  }
  if (!SameKeys(asked.set, stored.set)) {
    return fmt::format("its 'set' is {}, not {}", stored.set.dump(), asked.set.dump());
  }
  if (asked.final_episodes != stored.final_episodes) return "its final_episodes differ";
  if (asked.arms[0].name != stored.arms[0].name) {
    return fmt::format("its first arm, which ratios are taken to, is '{}', not '{}'",
                       stored.arms[0].name, asked.arms[0].name);
  }
  for (const Arm& arm : stored.arms) {
    const auto same = std::ranges::find(asked.arms, arm.name, &Arm::name);
    if (same == asked.arms.end()) return fmt::format("it has an arm '{}'", arm.name);
    if (!SameKeys(same->set, arm.set)) {
      return fmt::format("its arm '{}' sets {}, not {}", arm.name, arm.set.dump(),
                         same->set.dump());
    }
  }
  return "";
}

FileLock LockOrThrow(const fs::path& folder, Holding holding, milliseconds deadline) {
  auto lock = FileLock::Take(folder / kLockFile, holding, deadline);
  if (lock) return std::move(*lock);
  throw UsageError("experiment '{}' is being run by another process (it holds {})", folder.string(),
                   (folder / kLockFile).string());
}

void Write(const StoredExperiment& experiment) {
  const ordered_json object{{"schema", kFolderSchema},
                            {"definition", ToJson(experiment.definition)},
                            {"base", ToJson(experiment.base)},
                            {"created", experiment.created},
                            {"commit", BuildCommit()}};
  WriteFileAtomically(experiment.folder / kFile, object.dump(2) + "\n");
}

// The seed of a run folder "ARM-sSEED" of this arm.
std::optional<int64_t> SeedOf(const std::string& name, const std::string& arm) {
  const std::string start = arm + "-s";
  if (!name.starts_with(start)) return std::nullopt;
  int64_t seed = -1;
  const char* const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data() + start.size(), end, seed);
  if (error != std::errc() || rest != end || seed < 0) return std::nullopt;
  return seed;
}

}  // namespace

std::optional<ExperimentRun> StoredExperiment::RunNamed(const std::string& name) const {
  for (const Arm& arm : definition.arms) {
    const auto seed = SeedOf(name, arm.name);
    if (!seed) continue;
    const std::vector<ExperimentRun> runs = Runs({*seed});
    const auto run = std::ranges::find(runs, name, &ExperimentRun::name);
    if (run != runs.end()) return *run;
  }
  return std::nullopt;
}

std::vector<ExperimentRun> StoredExperiment::Runs(const std::vector<int64_t>& seeds) const {
  std::vector<ExperimentRun> runs;
  for (const int64_t seed : seeds) {
    for (size_t arm = 0; arm < definition.arms.size(); ++arm) {
      const std::string name = fmt::format("{}-s{}", definition.arms[arm].name, seed);
      runs.push_back({arm, seed, name, folder / "runs" / name});
    }
  }
  return runs;
}

std::vector<ExperimentRun> StoredExperiment::Runs() const {
  std::set<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder / "runs", error), end; !error && it != end;
       it.increment(error)) {
    names.insert(it->path().filename());
  }
  for (const auto& [name, run] : Log().Read()) names.insert(name);
  std::set<int64_t> further;
  for (const std::string& name : names) {
    for (const Arm& arm : definition.arms) {
      const auto seed = SeedOf(name, arm.name);
      if (seed && std::ranges::count(definition.seeds, *seed) == 0) further.insert(*seed);
    }
  }
  std::vector<int64_t> seeds = definition.seeds;
  seeds.insert(seeds.end(), further.begin(), further.end());
  return Runs(seeds);
}

StandingReport StoredExperiment::Standing(const ExperimentRun& run,
                                          const std::map<std::string, LoggedRun>& log) const {
  const auto known = log.find(run.name);
  return StandingOf(run.folder, known == log.end() ? nullptr : &known->second, definition.transfer);
}

fs::path StoredExperiment::LogFile(const ExperimentRun& run) const {
  return folder / kLogFolder / (run.name + ".log");
}

NamedKind ExperimentsIn(const fs::path& dir) {
  return {.noun = "experiment", .dir = dir, .file = kFile};
}

bool IsExperiment(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / kFile, error);
}

StoredExperiment WithArmsOf(const std::vector<ExperimentRun>& runs, StoredExperiment experiment) {
  std::vector<Arm> arms;
  for (size_t i = 0; i < experiment.definition.arms.size(); ++i) {
    if (std::ranges::count(runs, i, &ExperimentRun::arm) == 0) continue;
    arms.push_back(experiment.definition.arms[i]);
  }
  experiment.definition.arms = std::move(arms);
  return experiment;
}

StoredExperiment ReadExperiment(const fs::path& folder) {
  const fs::path path = folder / kFile;
  if (!IsExperiment(folder)) {
    throw UsageError("no experiment in '{}': it has no {}", folder.string(), kFile);
  }
  const std::string text = ReadFile(path);
  ParseStrictJson(text, path);  // refuses broken text and duplicate keys
  const auto object = ParseBoundedJson<ordered_json>(text);
  if (!object.is_object() || object.value("schema", ordered_json()) != kFolderSchema ||
      !object.contains("definition") || !object.contains("base")) {
    throw RuntimeError("{}: expected an object of schema '{}'", path.string(), kFolderSchema);
  }
  StoredExperiment experiment{.folder = fs::weakly_canonical(folder)};
  experiment.definition = ParseDefinition(object["definition"], path, "");
  ApplyStoredJson(nlohmann::json(object["base"]), path, &experiment.base);
  if (object.contains("created") && object["created"].is_string()) {
    experiment.created = object["created"].get<std::string>();
  }
  return experiment;
}

namespace {

// Reads the experiment in the folder; empty if the folder has none yet.
std::optional<StoredExperiment> ReadIfSame(const fs::path& folder, const Definition& definition,
                                           const std::string& source) {
  if (!IsExperiment(folder)) return std::nullopt;
  StoredExperiment stored = ReadExperiment(folder);
  const std::string difference = Difference(stored.definition, definition);
  if (!difference.empty()) {
    throw UsageError("'{}' holds another experiment than {}: {} (another folder: --out)",
                     folder.string(), source, difference);
  }
  return stored;
}

}  // namespace

namespace {

// The base of a new experiment. For a Python environment, completes keys and derives others from
// its spaces, as `shoal train` does.
Config MakeBase(const Definition& definition, const std::string& source) {
  Config base = ResolveBase(definition, source);
  if (base.env.id.empty()) return base;
  if (!definition.transfer.empty()) {
    throw UsageError("{}: transfer: a policy of environment {} plays that environment alone",
                     source, base.env.id);
  }
  CompleteEnvironmentKeys(&base);
  base = ResolveBase(definition, source,
                     DefaultsFor(DescribeEnvironment(base).description).assignments);
  CompleteEnvironmentKeys(&base);
  return base;
}

}  // namespace

ExperimentPlan PlanExperiment(const fs::path& folder, const Definition& definition,
                              const std::string& source) {
  std::error_code error;
  ExperimentPlan plan{.source = source};
  if (auto stored = ReadIfSame(folder, definition, source)) {
    plan.experiment = std::move(*stored);
  } else if (fs::exists(folder, error) && !HoldsOnlyLeftovers(folder)) {
    throw UsageError("'{}' holds something else than an experiment (no {}): not used",
                     folder.string(), kFile);
  } else {
    // No braced initialisation: if a member throws, g++ 12 destroys members that it has not
    // constructed.
    plan.experiment.folder = fs::weakly_canonical(fs::absolute(folder));
    plan.experiment.base = MakeBase(definition, source);
    plan.experiment.created = UtcTimestamp();
  }
  plan.experiment.definition = definition;
  for (const Arm& arm : definition.arms) {
    plan.arms.push_back(ArmConfig(plan.experiment.base, arm, source));
  }
  CheckTransfer(definition, source);
  CheckReference(definition, source);
  return plan;
}

ExperimentFolder::ExperimentFolder(const ExperimentPlan& plan) : experiment_(plan.experiment) {
  MakeFolders(experiment_.folder);
  lock_ = LockOrThrow(experiment_.folder, Holding::kAlone, milliseconds(0));
  // Check again: another command may have made the experiment between the plan and the lock.
  const auto stored = ReadIfSame(experiment_.folder, experiment_.definition, plan.source);
  if (stored) experiment_.base = stored->base;
  if (stored) experiment_.created = stored->created;
  for (const char* inner : {"configs", "runs", kLogFolder}) MakeFolders(experiment_.folder / inner);
  const bool changed = !stored || ToJson(stored->definition) != ToJson(experiment_.definition);
  if (changed) Write(experiment_);
}

ExperimentShare::ExperimentShare(const fs::path& folder)
    : lock_(LockOrThrow(folder, Holding::kWithOthers, kSubmission)),
      experiment_(ReadExperiment(folder)) {}

bool IsExperimentHeld(const fs::path& folder) { return IsLocked(folder / kLockFile); }

}  // namespace shoal::launch
