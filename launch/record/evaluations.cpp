#include "launch/record/evaluations.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

ordered_json ParseObject(const std::string& text, const std::string& source) {
  ordered_json object = ParseBoundedJson<ordered_json>(text);
  if (!object.is_object() || !object.contains("schema") || object["schema"] != kEvaluationSchema) {
    throw RuntimeError("{}: expected an object of schema '{}'", source, kEvaluationSchema);
  }
  return object;
}

// It becomes a path below "checkpoints"; the text came over the network.
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
  if (!std::isfinite(point.mean_length)) throw RuntimeError("{}: length_mean is no number", source);
  if (point.episodes == 0) throw RuntimeError("{}: no episodes", source);
}

EvaluationPoint PointOf(const ordered_json& object, const std::string& source) {
  EvaluationPoint point;
  try {
    const ordered_json& aggregate = object.at("aggregate");
    object.at("env_steps").get_to(point.env_steps);
    object.at("weights_version").at("session").get_to(point.learner_session);
    object.at("weights_version").at("update").get_to(point.updates);
    object.at("checkpoint").get_to(point.checkpoint);
    aggregate.at("return_mean").get_to(point.mean_return);
    aggregate.at("length_mean").get_to(point.mean_length);
    if (const auto std = aggregate.find("return_std"); std != aggregate.end()) {
      point.return_std = std->get<double>();
    }
    if (const ordered_json& success = aggregate.at("success_rate"); !success.is_null()) {
      point.success = success.get<double>();
    }
    point.episodes = object.at("episodes").size();
    point.wall_seconds = object.value("wall_seconds", 0.0);
  } catch (const nlohmann::json::exception& e) {
    throw RuntimeError("{}: {}", source, e.what());
  }
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
  return PointOf(ParseObject(json, source), source);
}

EvaluationPoint ParseEvaluation(const EvalMessage& message) {
  const std::string source = SourceOf(message);
  EvaluationPoint point = PointOf(ParseObject(message.json, source), source);
  if (point.env_steps != message.env_steps || point.updates != message.version.update ||
      point.learner_session != message.version.session || point.checkpoint != message.checkpoint) {
    throw RuntimeError("{}: its JSON tells of another one, at {} env steps, update {}", source,
                       point.env_steps, point.updates);
  }
  return point;
}

EvaluationPoint StoreEvaluation(const fs::path& run, const EvalMessage& message,
                                double wall_seconds) {
  const std::string source = SourceOf(message);
  ordered_json object = ParseObject(message.json, source);
  object["wall_seconds"] = wall_seconds;
  EvaluationPoint point = PointOf(object, source);
  const std::string name = fmt::format("{}{:010}_updates_{:010}.json", kEvaluationPrefix,
                                       point.env_steps, point.updates);
  WriteFileAtomically(run / kEvaluationFolder / name, object.dump(2) + "\n");
  return point;
}

std::vector<EvaluationPoint> ReadEvaluations(const fs::path& run) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(run / kEvaluationFolder)) {
    const std::string name = entry.path().filename();
    if (name.starts_with(kEvaluationPrefix) && name.ends_with(".json"))
      files.push_back(entry.path());
  }
  std::ranges::sort(files);  // the names are padded: by env steps, then updates
  std::vector<EvaluationPoint> points;
  points.reserve(files.size());
  for (const fs::path& file : files) points.push_back(ParseEvaluation(ReadFile(file), file));
  return points;
}

}  // namespace shoal::launch
