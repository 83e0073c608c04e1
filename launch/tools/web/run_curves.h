// SPDX-License-Identifier: Apache-2.0
// A run's curves over env steps, read from its files as they grow: metrics.jsonl and eval/.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "launch/record/evaluation_point.h"

namespace shoal::launch {

// A curve of bounded size. When the curve is full, every second point is removed, and the spacing
// of points that are kept later doubles. The newest point is always included.
class ThinnedCurve {
 public:
  struct Point {
    double x = 0, y = 0;
  };
  static constexpr size_t kMost = 1000;

  void Add(double x, double y);
  std::vector<Point> Points() const;

 private:
  std::vector<Point> kept_;
  Point newest_{};
  bool newest_kept_ = true;
  uint64_t stride_ = 1, seen_ = 0;
};

// One thread.
class RunCurves {
 public:
  explicit RunCurves(const std::filesystem::path& run) : run_(run) {}

  // Reads the lines added since the last call, at most `most_bytes`. A file that was replaced is
  // read from its beginning. Never throws because of the files' content: invalid lines are skipped.
  void ReadOn(uint64_t most_bytes = 8'000'000);

  // {"complete": whether the files have been read to their end,
  //  "charts": [{"id", "title", "meaning", "series": [{"name", "points": [[x, y], ...]}]}]}.
  // Only charts with at least one point are included.
  std::string Json() const;

 private:
  void ReadMetrics(uint64_t most_bytes);
  void ReadEvaluationFiles();
  void OnLine(const std::string& line);

  const std::filesystem::path run_;
  uint64_t read_bytes_ = 0, inode_ = 0;
  bool complete_ = false;
  double env_steps_ = 0;                        // of the learner's newest line
  std::map<std::string, ThinnedCurve> curves_;  // by metric
  std::filesystem::file_time_type evaluations_of_{};
  std::vector<EvaluationPoint> evaluations_;
};

}  // namespace shoal::launch
