// SPDX-License-Identifier: Apache-2.0
#include "launch/record/metrics_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "common/base/disk_steps.h"
#include "common/base/error.h"
#include "common/base/files.h"

namespace shoal::launch {
namespace {

// Integers in full; other figures with six significant digits; null if not finite.
std::string Figure(double value) {
  if (!std::isfinite(value)) return "null";
  if (value == std::floor(value) && std::abs(value) < 1e15) {
    return fmt::format("{}", static_cast<int64_t>(value));
  }
  return fmt::format("{:.6g}", value);
}

std::string Line(const MetricsMessage& message) {
  // Names are received over the network: invalid UTF-8 in them is replaced.
  const auto quoted = [](const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', /*ensure_ascii=*/false,
                                     nlohmann::json::error_handler_t::replace);
  };
  std::string line = fmt::format(R"({{"t":{:.3f},"role":{},"id":{},"host":{},"pid":{},"state":{})",
                                 message.time, quoted(message.role), message.id,
                                 quoted(message.host), message.pid, quoted(message.state));
  for (size_t i = 0; i < message.names.size() && i < message.values.size(); ++i) {
    line += fmt::format(",{}:{}", quoted(message.names[i]), Figure(message.values[i]));
  }
  return line + "}\n";
}

}  // namespace

MetricsLog::MetricsLog(const std::filesystem::path& file, const MetricsLogLimits& limits)
    : path_(file), file_(OpenRegular(file, O_RDWR | O_CREAT | O_APPEND)), limits_(limits) {
  bytes_ = std::filesystem::file_size(file);
  char last = '\n';
  // A power failure or a full disk may have cut off the last line.
  if (bytes_ > 0 && pread(file_.get(), &last, 1, static_cast<off_t>(bytes_ - 1)) == 1 &&
      last != '\n') {
    kept_ = "\n";
  }
}

// Also true if the clock was set back, so that no process is silenced until the clock catches up.
bool MetricsLog::Due(const MetricsMessage& message, const Last& last) const {
  if (bytes_ < limits_.burst_bytes || message.pid != last.pid || message.state == "stopping") {
    return true;
  }
  size_t round = 0;  // bytes of one line per process
  for (const auto& [process, line] : last_) round += line.bytes;
  const double interval =
      3600 * static_cast<double>(round) / static_cast<double>(limits_.bytes_per_hour);
  const double since = message.time - last.time;
  return since < 0 || since >= interval;
}

void MetricsLog::Write(const MetricsMessage& message) {
  Last& last = last_[{message.role, message.id}];
  if (!Due(message, last)) {
    ++left_out_;
    return;
  }
  const std::string text = Line(message);
  if (bytes_ + kept_.size() + text.size() > limits_.most_bytes) {
    ++left_out_;
    full_ = true;
    return;
  }
  kept_ += text;
  last = {message.time, message.pid, text.size()};
  while (kept_.size() > limits_.kept_bytes) DropOldest();
}

void MetricsLog::DropOldest() {
  const size_t from = begun_ ? kept_.find('\n') + 1 : 0;
  const size_t end = kept_.find('\n', from);
  kept_.erase(from, end == std::string::npos ? end : end + 1 - from);
  ++left_out_;
}

void MetricsLog::Flush() {
  size_t done = 0;
  int error = kept_.empty() ? 0 : DiskStep(path_);
  while (done < kept_.size() && error == 0) {
    const ssize_t n = write(file_.get(), kept_.data() + done, kept_.size() - done);
    if (n >= 0) done += static_cast<size_t>(n);
    if (n < 0 && errno != EINTR) error = errno;
  }
  if (done > 0) begun_ = kept_[done - 1] != '\n';
  bytes_ += done;
  kept_.erase(0, done);
  if (error != 0) {
    throw RuntimeError("cannot write '{}': {}", path_.string(), std::strerror(error));
  }
}

}  // namespace shoal::launch
