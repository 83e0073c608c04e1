// SPDX-License-Identifier: Apache-2.0
// metrics.jsonl: {t, role, id, host, pid, state, NAME: value, ...} per line. In the first minutes,
// each process gets one line per second. Later, lines are less frequent, so that the file stays
// within its hourly budget for any number of processes. The first and the last report (state
// "stopping") of a process are always written. Metrics have six significant digits; counts are
// written in full.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "common/base/descriptor.h"
#include "common/wire/messages.h"

namespace shoal::launch {

struct MetricsLogLimits {
  uint64_t burst_bytes = 1'500'000;     // up to this size every report is written
  uint64_t bytes_per_hour = 3'000'000;  // above burst_bytes
  uint64_t most_bytes = 256'000'000;    // largest size of the file
  size_t kept_bytes = 4'000'000;        // largest size of lines that wait for space on the disk
};

// Appends to the file, so that a resumed run continues the file. Keeps the newest kept_bytes of the
// lines that cannot be written. One thread.
class MetricsLog {
 public:
  // Throws Error if the file cannot be opened.
  MetricsLog(const std::filesystem::path& file, const MetricsLogLimits& limits);

  // Adds a line for the next Flush. Metrics that are not finite are written as null.
  void Write(const MetricsMessage& message);
  // Writes the lines to the file. Throws Error if the file cannot be written; a later call
  // continues where the failed call stopped.
  void Flush();
  // True if the file has reached its size limit.
  bool full() const { return full_; }
  uint64_t lines_left_out() const { return left_out_; }

 private:
  void DropOldest();

  const std::filesystem::path path_;
  Descriptor file_;
  const MetricsLogLimits limits_;
  uint64_t bytes_ = 0, left_out_ = 0;
  bool full_ = false;
  std::string kept_;    // lines for the file; part of the first line may be written already
  bool begun_ = false;  // part of a line is written: the file ends within a line
  struct Last {         // last line of a process
    double time = 0;
    int32_t pid = 0;
    size_t bytes = 0;
  };
  bool Due(const MetricsMessage& message, const Last& last) const;

  std::map<std::pair<std::string, uint32_t>, Last> last_;
};

}  // namespace shoal::launch
