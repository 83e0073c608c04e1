// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_record.h"

#include <fmt/core.h>

#include <utility>

#include "common/base/error.h"
#include "common/run_folder/learner_device_file.h"
#include "common/run_folder/run_file_names.h"
#include "common/run_folder/update_page.h"
#include "launch/record/kept_checkpoints.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {

RunRecord::RunRecord(const std::filesystem::path& run, const Config& config,
                     std::function<void(const std::string&)> say)
    : run_(run), config_(config), say_(std::move(say)), faults_(say_), scalars_(run) {}

void RunRecord::WriteMeta(RunMeta meta) {
  SayLearnerDevice();
  faults_.Try(kMetaFile, [&] {
    meta.updates_lost = ReadLostUpdates(run_);
    WriteRunMeta(run_, config_, meta);
  });
}

void RunRecord::SayLearnerDevice() {
  if (config_.learner.device == "cpu") return;
  try {
    const auto device = ReadLearnerDevice(run_);
    if (!device || Describe(*device) == learner_device_) return;
    learner_device_ = Describe(*device);
    say_(fmt::format("learner.device = {}: the learner computes on {}", config_.learner.device,
                     learner_device_));
  } catch (const Error&) {  // damaged; the next start of the learner replaces the file
  }
}

void RunRecord::FlushScalars() {
  faults_.Try(kTensorBoardFolder, [this] { scalars_.Flush(); });
}

void RunRecord::OnUnwrittenCheckpoints(double unwritten, const std::string& learner) {
  const auto line = checkpoints_.OnUnwritten(unwritten, learner, LogFile(run_, learner).string());
  if (line) say_(*line);
}

void RunRecord::KeepCheckpointsOf(const std::vector<EvaluationPoint>& candidates) {
  const auto choice = checkpoints_.Choose(
      candidates, [this](const std::string& checkpoint) { return Exists(checkpoint); });
  if (!choice) return;
  for (const std::string& line : choice->lines) say_(line);
  const bool kept = faults_.Try(fmt::format("{}/{}", kCheckpointFolder, kBestCheckpoint), [&] {
    // If this fails, the previous best checkpoint remains complete.
    if (!choice->names.empty()) KeepCheckpoints(run_, choice->names, choice->best);
  });
  not_kept_ = kept ? std::nullopt : std::optional(candidates);
}

bool RunRecord::Exists(const std::string& checkpoint) const {
  std::error_code error;
  const std::filesystem::path folder = run_ / kCheckpointFolder;
  return std::filesystem::exists(folder / checkpoint, error) ||
         std::filesystem::exists(folder / kCandidateFolder / checkpoint, error);
}

void RunRecord::Retry() {
  evaluations_.Retry();
  if (not_kept_) KeepCheckpointsOf(std::vector<EvaluationPoint>(*not_kept_));
  FlushScalars();
}

}  // namespace shoal::launch
