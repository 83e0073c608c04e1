// SPDX-License-Identifier: Apache-2.0
// Writes eval/*.json of a run when evaluations arrive, and reads these files when the run is
// resumed.
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

// Reads the results of a shoal-eval-1 object; `source` names the text in errors. Throws Error for
// other text, and for impossible results: a success rate outside of 0..1, a return that is not
// finite, no episodes.
EvaluationPoint ParseEvaluation(const std::string& json, const std::string& source);

// Reads the results of a message. Throws Error, also if the fields of the message differ from its
// JSON.
EvaluationPoint ParseEvaluation(const EvalMessage& message);

// An evaluation in the form that a run stores.
struct EvaluationRecord {
  EvaluationPoint point;
  std::string name;  // file name in eval/: STEPS_UPDATES.json
  std::string text;  // the message's JSON, with `wall_seconds` added
};
// Throws Error if the message is not an evaluation.
EvaluationRecord RecordOf(const EvalMessage& message, double wall_seconds);

// Writes evaluations into a run's folder. Evaluations that cannot be written are kept in memory for
// Retry, at most the newest kMostKept. One thread.
class EvaluationStore {
 public:
  // Borrows `faults`, which reports and counts failed writes under the name eval.
  EvaluationStore(std::filesystem::path run, WriteFaults* faults)
      : run_(std::move(run)), faults_(*faults) {}

  void Write(EvaluationRecord record);
  // Writes the kept evaluations, oldest first.
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
