// SPDX-License-Identifier: Apache-2.0
#include "learner/checkpoint_store.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/base/build_info.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/log.h"
#include "common/config/config_io.h"
#include "common/config/run_files.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::learner {
namespace {

namespace fs = std::filesystem;

}  // namespace

CheckpointStore::CheckpointStore(const fs::path& run_folder, const RunConfig& run)
    : folder_(run_folder / kCheckpointFolder),
      run_(run),
      config_hash_(ConfigHash(run.config)),
      config_text_(RunConfigText(run)),
      faults_([](const std::string& line) { log::Warning("{}", line); }) {
  MakeFolders(folder_);
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    const std::string name = entry.path().filename();
    if (name.starts_with(".step_")) fs::remove_all(entry.path(), ignored);  // of a killed process
  }
}

std::optional<Checkpoint> CheckpointStore::RestoreNewest() {
  std::vector<fs::path> refused;
  std::string newest_fault;
  for (const uint64_t updates : Existing()) {
    const std::string name = CheckpointName(updates);
    try {
      Checkpoint checkpoint = ReadCheckpoint(folder_ / name, run_.spec.Hash());
      if (checkpoint.state.config_hash != config_hash_) {
        log::Warning("{} was written with another configuration: continuing with the present one",
                     name);
      }
      // Sets refused checkpoints aside, so that the next start does not try them again.
      for (const fs::path& path : refused) {
        std::error_code ignored;
        fs::remove_all(folder_ / ("refused_" + path.filename().string()), ignored);
        fs::rename(path, folder_ / ("refused_" + path.filename().string()), ignored);
      }
      return checkpoint;
    } catch (const Error& e) {
      if (newest_fault.empty()) newest_fault = e.what();
      log::Warning("checkpoint refused: {}", e.what());
      refused.push_back(folder_ / name);
    }
  }
  if (refused.empty()) return std::nullopt;
  throw UsageError(
      "none of {} checkpoint(s) can be used; the newest: {}; restore one, or move '{}' away to "
      "train from scratch with the existing replay",
      refused.size(), newest_fault, folder_.string());
}

std::string CheckpointStore::Write(const CheckpointState& state, nn::TensorMap learner,
                                   nn::TensorMap policy, const std::set<std::string>& wanted) {
  unwritten_.push_back({state, std::move(learner), std::move(policy)});
  if (unwritten_.size() > kMostUnwritten) {
    log::Warning("{} was never written and is given up for a newer one",
                 CheckpointName(unwritten_.front().state.updates));
    unwritten_.pop_front();
  }
  WriteKept(wanted);
  return CheckpointName(state.updates);
}

void CheckpointStore::Retry(const std::set<std::string>& wanted, bool now) {
  if (unwritten_.empty() || (!now && Now() - tried_ < kRetryPeriod)) return;
  WriteKept(wanted);
}

void CheckpointStore::WriteKept(const std::set<std::string>& wanted) {
  tried_ = Now();
  faults_.Try("checkpoint", [&] {
    CheckWritable(folder_ / ".new");  // do not recreate the folder of a run that was moved away
    while (!unwritten_.empty()) {
      const Unwritten& next = unwritten_.front();
      WriteCheckpoint(folder_, next.state, next.learner, next.policy, run_, Meta(next.state));
      // The configuration lets a copy of the folder be evaluated and filmed without the run.
      WriteFileAtomically(folder_ / CheckpointName(next.state.updates) / kConfigFile, config_text_);
      unwritten_.pop_front();
    }
    Prune(wanted);
  });
}

std::optional<uint64_t> CheckpointStore::UnwrittenUpdates() const {
  if (unwritten_.empty()) return std::nullopt;
  return unwritten_.back().state.updates;
}

std::optional<uint64_t> CheckpointStore::WrittenUpdates() const {
  const std::vector<uint64_t> existing = Existing();
  return existing.empty() ? std::nullopt : std::optional(existing.front());
}

void CheckpointStore::Prune(const std::set<std::string>& wanted) {
  const std::vector<uint64_t> existing = Existing();
  for (size_t i = kKept; i < existing.size(); ++i) {
    const std::string name = CheckpointName(existing[i]);
    if (!wanted.contains(name)) Remove(name);
  }
}

std::vector<uint64_t> CheckpointStore::Existing() const {
  std::vector<uint64_t> existing;
  std::error_code error;  // the folder may have been moved away
  for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error)) {
    const auto updates = CheckpointUpdates(it->path().filename());
    if (updates && it->is_directory(error)) existing.push_back(*updates);
  }
  std::ranges::sort(existing, std::greater());
  return existing;
}

// Renames the folder first, so that no reader finds a checkpoint with only some of its files.
void CheckpointStore::Remove(const std::string& name) {
  std::error_code error;
  const fs::path going = folder_ / ("." + name + ".old");
  fs::rename(folder_ / name, going, error);
  if (!error) fs::remove_all(going, error);
  if (error) log::Warning("cannot remove checkpoint {}: {}", name, error.message());
}

nlohmann::ordered_json CheckpointStore::Meta(const CheckpointState& state) const {
  return {{"schema", kCheckpointMetaSchema},
          {"checkpoint", CheckpointName(state.updates)},
          {"run", run_.config.run_name},
          {"task", run_.config.task},
          {"preset", run_.config.preset},
          {"seed", run_.config.seed},
          {"updates", state.updates},
          {"env_steps", state.env_steps},
          {"algorithm", state.algorithm},
          {"precision", state.precision},
          {"observation", run_.spec.Summary()},
          {"version", BuildVersion()},
          {"commit", BuildCommit()},
          {"created", UtcTimestamp()}};
}

}  // namespace shoal::learner
