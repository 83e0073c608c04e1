// SPDX-License-Identifier: Apache-2.0
// eval/*.json of a run: written as evaluations arrive, read back when a run goes on.
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/base/write_faults.h"
#include "common/wire/messages.h"
#include "launch/record/evaluation_point.h"

namespace shoal::launch {

// Reads the figures of a shoal-eval-1 object; `source` names the text. Throws Error on anything
// else, and where the figures cannot be: a success rate outside of 0..1, a return that is not
// finite, no episodes.
EvaluationPoint ParseEvaluation(const std::string& json, const std::string& source);

// The figures of a message, whose own fields must say what its JSON says. Throws Error.
EvaluationPoint ParseEvaluation(const EvalMessage& message);

// An evaluation as a run keeps it.
struct EvaluationRecord {
  EvaluationPoint point;
  std::string name;  // in eval/: STEPS_UPDATES.json
  std::string text;  // the message's JSON, with `wall_seconds` added
};
// Throws Error when the message is not an evaluation.
EvaluationRecord RecordOf(const EvalMessage& message, double wall_seconds);

// Writes evaluations into a run's folder. Files that cannot be written are kept in memory, up to
// kMostKept of them, for Retry. One thread.
class EvaluationStore {
 public:
  // Borrows `faults`, which reports and counts them as eval.
  EvaluationStore(std::filesystem::path run, WriteFaults* faults)
      : run_(std::move(run)), faults_(*faults) {}

  void Write(EvaluationRecord record);
  // Writes what is kept, oldest first.
  void Retry();

  static constexpr size_t kMostKept = 1000;

 private:
  const std::filesystem::path run_;
  WriteFaults& faults_;
  std::deque<EvaluationRecord> kept_;
};

// Reads the evaluations that an EvaluationStore wrote, sorted by env steps. Throws Error naming a
// broken file.
std::vector<EvaluationPoint> ReadEvaluations(const std::filesystem::path& run);

}  // namespace shoal::launch
