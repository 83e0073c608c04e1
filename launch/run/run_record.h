// SPDX-License-Identifier: Apache-2.0
// The files that a coordinator writes during a run: meta.json, evaluations, TensorBoard events, and
// the checkpoints that are kept after the learner has deleted its own. A file that cannot be
// written is reported once and tried again.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/write_faults.h"
#include "common/config/config.h"
#include "launch/record/evaluations.h"
#include "launch/record/run_meta.h"
#include "launch/run/candidate_checkpoints.h"
#include "launch/watch/scalar_log.h"

namespace shoal::launch {

// One thread.
class RunRecord {
 public:
  // `say` gets lines for people.
  RunRecord(const std::filesystem::path& run, const Config& config,
            std::function<void(const std::string&)> say);

  WriteFaults& faults() { return faults_; }
  ScalarLog& scalars() { return scalars_; }

  // Writes meta.json with `updates_lost` added.
  void WriteMeta(RunMeta meta);
  void WriteEvaluation(EvaluationRecord record) { evaluations_.Write(std::move(record)); }
  void FlushScalars();

  // `unwritten`: number of checkpoints that the learner could not write.
  void OnUnwrittenCheckpoints(double unwritten, const std::string& learner);
  // Keeps the checkpoints of these evaluations and removes the other kept checkpoints.
  void KeepCheckpointsOf(const std::vector<EvaluationPoint>& candidates);

  // Tries again to write the files that could not be written.
  void Retry();

 private:
  // Prints a line if the learner has chosen a processor, or another one than before.
  void SayLearnerDevice();
  bool Exists(const std::string& checkpoint) const;

  const std::filesystem::path run_;
  const Config config_;
  const std::function<void(const std::string&)> say_;
  WriteFaults faults_;
  EvaluationStore evaluations_{run_, &faults_};
  ScalarLog scalars_;
  CandidateCheckpoints checkpoints_;
  std::string learner_device_;                            // processor of the last line
  std::optional<std::vector<EvaluationPoint>> not_kept_;  // candidates of the last attempt
};

}  // namespace shoal::launch
