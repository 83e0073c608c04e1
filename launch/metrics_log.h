// metrics.jsonl: one line per process and second, {t, role, id, state, pid, NAME: value, ...}.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <utility>

#include "common/wire/messages.h"

namespace shoal::launch {

struct MetricsLogLimits {
  uint64_t thin_bytes = 128'000'000;  // from here on a line per process every `thin_seconds`
  uint64_t most_bytes = 256'000'000;  // nothing is written beyond
  double thin_seconds = 10;
};

// Appends to the file, so that a resumed run goes on in it. One thread.
class MetricsLog {
 public:
  // Throws Error when the file cannot be opened.
  MetricsLog(const std::filesystem::path& file, const MetricsLogLimits& limits);

  // Figures that are not finite are written as null. False when the line could not be written, for
  // the first time: a full disk or the size limit.
  bool Write(const MetricsMessage& message);
  uint64_t lines_left_out() const { return left_out_; }

 private:
  std::ofstream out_;
  const MetricsLogLimits limits_;
  uint64_t bytes_ = 0, left_out_ = 0;
  bool failed_ = false;
  std::map<std::pair<std::string, uint32_t>, double> last_;  // time of each process's last line
};

}  // namespace shoal::launch
