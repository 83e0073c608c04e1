// SPDX-License-Identifier: Apache-2.0
#include "launch/record/rollout_curve.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "common/base/bounded_json.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::launch {
namespace {

using nlohmann::json;

// Longer lines are skipped as damaged: a process reports only about a hundred figures.
constexpr size_t kLongestLine = 64'000;

std::optional<double> Number(const json& line, const char* name) {
  const auto at = line.find(name);
  return at != line.end() && at->is_number() ? std::optional(at->get<double>()) : std::nullopt;
}

bool IsOf(std::string_view line, std::string_view role) { return line.find(role) != line.npos; }

// Keeps at most `most` points by leaving out every second one whenever there are more.
class Thinned {
 public:
  explicit Thinned(size_t most) : most_(most) {}

  void Add(const RolloutPoint& point) {
    if (seen_++ % stride_ != 0) return;
    points_.push_back(point);
    if (points_.size() <= most_) return;
    for (size_t i = 0; 2 * i < points_.size(); ++i) points_[i] = points_[2 * i];
    points_.resize((points_.size() + 1) / 2);
    stride_ *= 2;
  }
  std::vector<RolloutPoint> Take() { return std::move(points_); }

 private:
  const size_t most_;
  size_t seen_ = 0, stride_ = 1;
  std::vector<RolloutPoint> points_;
};

}  // namespace

std::vector<RolloutPoint> ReadRolloutCurve(const std::filesystem::path& run, size_t most) {
  std::ifstream in(run / kMetricsFile, std::ios::binary);
  Thinned curve(most);
  double env_steps = 0, updates = 0;  // from the learner's newest line
  for (std::string text; std::getline(in, text);) {
    // Most lines are those of actors. They are not parsed.
    const bool of_learner = IsOf(text, R"("role":"learner")");
    if (text.size() > kLongestLine || (!of_learner && !IsOf(text, R"("role":"coordinator")"))) {
      continue;
    }
    const json line = ParseBoundedJson<json>(text);
    if (!line.is_object()) continue;
    if (of_learner) {
      env_steps = Number(line, "env_steps").value_or(env_steps);
      updates = Number(line, "updates").value_or(updates);
      continue;
    }
    const RolloutPoint point{.env_steps = Number(line, "env_steps").value_or(env_steps),
                             .updates = updates,
                             .wall_seconds = Number(line, "elapsed_seconds").value_or(0),
                             .success = Number(line, "rollout_success"),
                             .episode_return = Number(line, "rollout_return")};
    if (point.success || point.episode_return) curve.Add(point);
  }
  return curve.Take();
}

}  // namespace shoal::launch
