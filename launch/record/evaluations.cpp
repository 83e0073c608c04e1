// SPDX-License-Identifier: Apache-2.0
#include "launch/record/evaluations.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/run_folder/evaluation_file.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// The name was received over the network and becomes a path below "checkpoints".
bool IsPlainName(const std::string& name) {
  return name != "." && name != ".." && name.find('/') == std::string::npos;
}

void CheckFigures(const EvaluationPoint& point, const std::string& source) {
  if (point.success && !(*point.success >= 0 && *point.success <= 1)) {
    throw RuntimeError("{}: success_rate {}: expected 0 to 1", source, *point.success);
  }
  if (!std::isfinite(point.mean_return)) throw RuntimeError("{}: return_mean is no number", source);
  if (point.return_std && !std::isfinite(*point.return_std)) {
    throw RuntimeError("{}: return_std is no number", source);
  }
  if (point.final_distance && !std::isfinite(*point.final_distance)) {
    throw RuntimeError("{}: final_distance_mean is no number", source);
  }
  if (!std::isfinite(point.mean_length)) throw RuntimeError("{}: length_mean is no number", source);
  if (point.faulty_episodes > point.episodes) {
    throw RuntimeError("{}: {} faulty episodes of {}", source, point.faulty_episodes,
                       point.episodes);
  }
  if (point.episodes == 0) throw RuntimeError("{}: no episodes", source);
}

EvaluationPoint PointOf(const ordered_json& object, const std::string& source) {
  const EvaluationSummary summary = SummaryOf(object, source);
  if (!summary.checkpoint || !summary.version) {
    throw RuntimeError("{}: expected a checkpoint and its weights_version", source);
  }
  EvaluationPoint point{.env_steps = summary.env_steps,
                        .updates = summary.version->update,
                        .wall_seconds = summary.wall_seconds,
                        .success = summary.aggregate.success_rate,
                        .mean_return = summary.aggregate.return_mean,
                        .return_std = summary.aggregate.return_std,
                        .mean_length = summary.aggregate.length_mean,
                        .final_distance = summary.aggregate.final_distance_mean,
                        .checkpoint = *summary.checkpoint,
                        .episodes = summary.aggregate.episodes,
                        .learner_session = summary.version->session,
                        .faulty_episodes = summary.aggregate.faulty_episodes};
  if (!IsPlainName(point.checkpoint)) {
    throw RuntimeError("{}: checkpoint '{}': expected a folder's name without a path", source,
                       point.checkpoint);
  }
  CheckFigures(point, source);
  return point;
}

std::string SourceOf(const EvalMessage& message) {
  return fmt::format("evaluation at {} env steps", message.env_steps);
}

}  // namespace

EvaluationPoint ParseEvaluation(const std::string& json, const std::string& source) {
  return PointOf(ParseEvaluationObject(json, source), source);
}

EvaluationPoint ParseEvaluation(const EvalMessage& message) {
  const std::string source = SourceOf(message);
  EvaluationPoint point = PointOf(ParseEvaluationObject(message.json, source), source);
  if (point.env_steps != message.env_steps || point.updates != message.version.update ||
      point.learner_session != message.version.session || point.checkpoint != message.checkpoint) {
    throw RuntimeError("{}: its JSON describes another evaluation, at {} env steps, update {}",
                       source, point.env_steps, point.updates);
  }
  return point;
}

EvaluationRecord RecordOf(const EvalMessage& message, double wall_seconds) {
  const std::string source = SourceOf(message);
  ordered_json object = ParseEvaluationObject(message.json, source);
  SetWallSeconds(wall_seconds, &object);
  EvaluationRecord record;
  record.point = PointOf(object, source);
  record.name = fmt::format("{}{:010}_updates_{:010}.json", kEvaluationPrefix,
                            record.point.env_steps, record.point.updates);
  record.text = object.dump(2) + "\n";
  return record;
}

void EvaluationStore::Write(EvaluationRecord record) {
  kept_.push_back(std::move(record));
  if (kept_.size() > kMostKept) kept_.pop_front();
  Retry();
}

void EvaluationStore::Retry() {
  if (kept_.empty()) return;
  faults_.Try(kEvaluationFolder, [this] {
    while (!kept_.empty()) {
      const EvaluationRecord& record = kept_.front();
      WriteFileAtomically(run_ / kEvaluationFolder / record.name, record.text);
      kept_.pop_front();
    }
  });
}

std::vector<EvaluationPoint> ReadEvaluations(const fs::path& run) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(run / kEvaluationFolder)) {
    const std::string name = entry.path().filename();
    if (name.starts_with(kEvaluationPrefix) && name.ends_with(".json"))
      files.push_back(entry.path());
  }
  std::ranges::sort(files);  // names are zero-padded: sorts by env steps, then updates
  std::vector<EvaluationPoint> points;
  points.reserve(files.size());
  for (const fs::path& file : files) points.push_back(ParseEvaluation(ReadFile(file), file));
  return points;
}

}  // namespace shoal::launch
