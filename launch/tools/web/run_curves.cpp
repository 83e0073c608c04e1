// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/run_curves.h"

#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/evaluations.h"
#include "learner/agent/algorithms.h"

namespace shoal::launch {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr char kSuccess[] = "rollout_success", kReturn[] = "rollout_return",
               kEnvSteps[] = "env_steps_per_second", kUpdates[] = "updates_per_second";
// Bytes; longer lines are skipped. A process reports about a hundred figures per line.
constexpr size_t kLongestLine = 64'000;

// True if the metric `name` is taken from lines of this role.
bool Wanted(std::string_view role, std::string_view name) {
  if (role == "coordinator") return name == kSuccess || name == kReturn || name == kEnvSteps;
  if (name == kUpdates) return true;
  for (const learner::Figure* figure : learner::AllFigures()) {
    if (figure->name == name) return figure->headline;
  }
  return false;
}

ordered_json ToJson(const std::vector<ThinnedCurve::Point>& points) {
  ordered_json array = ordered_json::array();
  for (const auto& point : points) array.push_back({point.x, point.y});
  return array;
}

}  // namespace

void ThinnedCurve::Add(double x, double y) {
  newest_ = {x, y};
  newest_kept_ = seen_++ % stride_ == 0;
  if (!newest_kept_) return;
  kept_.push_back(newest_);
  if (kept_.size() < kMost) return;
  for (size_t i = 0; i < kept_.size() / 2; ++i) kept_[i] = kept_[2 * i];
  kept_.resize(kept_.size() / 2);
  stride_ *= 2;
  newest_kept_ = false;
}

std::vector<ThinnedCurve::Point> ThinnedCurve::Points() const {
  std::vector<Point> points = kept_;
  if (!newest_kept_) points.push_back(newest_);
  return points;
}

void RunCurves::ReadOn(uint64_t most_bytes) {
  ReadMetrics(most_bytes);
  ReadEvaluationFiles();
}

void RunCurves::ReadMetrics(uint64_t most_bytes) {
  const std::filesystem::path file = run_ / kMetricsFile;
  struct stat status {};
  complete_ = true;
  if (stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return;
  const auto size = static_cast<uint64_t>(status.st_size);
  if (status.st_ino != inode_ || size < read_bytes_) {
    inode_ = status.st_ino;
    read_bytes_ = 0;
    env_steps_ = 0;
    curves_.clear();
  }
  if (size == read_bytes_) return;
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(read_bytes_));
  uint64_t read = 0;
  std::string line;
  while (read < most_bytes && std::getline(in, line)) {
    if (in.eof()) break;  // the line is not complete yet
    read += line.size() + 1;
    OnLine(line);
  }
  read_bytes_ += read;
  complete_ = read < most_bytes;
}

void RunCurves::OnLine(const std::string& line) {
  // Most lines are of other roles; skip them without parsing.
  const bool learner = line.find(R"("role":"learner")") != std::string::npos;
  if (line.size() > kLongestLine ||
      (!learner && line.find(R"("role":"coordinator")") == std::string::npos)) {
    return;
  }
  const json object = ParseBoundedJson<json>(line);
  if (!object.is_object()) return;
  // The learner's figures belong to the env steps of its last batch, the coordinator's to the
  // present ones.
  double env_steps = env_steps_;
  if (const auto steps = object.find("env_steps"); steps != object.end() && steps->is_number()) {
    env_steps = steps->get<double>();
    if (learner) env_steps_ = env_steps;
  }
  for (const auto& [name, value] : object.items()) {
    if (!value.is_number() || !Wanted(learner ? "learner" : "coordinator", name)) continue;
    curves_[name].Add(env_steps, value.get<double>());
  }
}

void RunCurves::ReadEvaluationFiles() {
  // Each evaluation is renamed into the folder, which changes the folder's time.
  std::error_code error;
  const auto changed = std::filesystem::last_write_time(run_ / kEvaluationFolder, error);
  if (error || changed == evaluations_of_) return;
  try {
    evaluations_ = ReadEvaluations(run_);
    evaluations_of_ = changed;
  } catch (const Error&) {
    // If a file is broken, the previous curve stays; `shoal report` names the file.
  }
}

std::string RunCurves::Json() const {
  ordered_json charts = ordered_json::array();
  const auto points_of = [&](const char* name) {
    const auto it = curves_.find(name);
    return it == curves_.end() ? std::vector<ThinnedCurve::Point>() : it->second.Points();
  };
  const auto add = [&](const std::string& id, const std::string& title, const std::string& meaning,
                       const std::vector<std::pair<std::string, ordered_json>>& all) {
    ordered_json series = ordered_json::array();
    for (const auto& [name, points] : all) {
      if (!points.empty()) series.push_back({{"name", name}, {"points", points}});
    }
    if (series.empty()) return;
    charts.push_back({{"id", id}, {"title", title}, {"meaning", meaning}, {"series", series}});
  };
  ordered_json success = ordered_json::array(), returns = ordered_json::array();
  for (const EvaluationPoint& point : evaluations_) {
    if (point.success) success.push_back({point.env_steps, *point.success});
    returns.push_back({point.env_steps, point.mean_return});
  }
  add("success", "Success rate", "success rate of whole episodes",
      {{"evaluations", success}, {"actors", ToJson(points_of(kSuccess))}});
  add("return", "Return", "mean return of whole episodes, unscaled",
      {{"evaluations", returns}, {"actors", ToJson(points_of(kReturn))}});
  for (const learner::Figure* figure : learner::AllFigures()) {
    if (!figure->headline) continue;
    const std::string name(figure->name);
    add(name, name, std::string(figure->meaning), {{name, ToJson(points_of(name.c_str()))}});
  }
  add("env_steps_per_second", "Env steps per second", "env steps per second of all actors",
      {{"env steps/s", ToJson(points_of(kEnvSteps))}});
  add("updates_per_second", "Updates per second", "updates per second of the learner",
      {{"updates/s", ToJson(points_of(kUpdates))}});
  return ordered_json{{"complete", complete_}, {"charts", charts}}.dump();
}

}  // namespace shoal::launch
