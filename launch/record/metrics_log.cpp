// SPDX-License-Identifier: Apache-2.0
#include "launch/record/metrics_log.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "common/base/error.h"

namespace shoal::launch {
namespace {

// Counts as they are; other figures with six significant digits; null for what is not finite.
std::string Figure(double value) {
  if (!std::isfinite(value)) return "null";
  if (value == std::floor(value) && std::abs(value) < 1e15) {
    return fmt::format("{}", static_cast<int64_t>(value));
  }
  return fmt::format("{:.6g}", value);
}

std::string Line(const MetricsMessage& message) {
  // Names come over the network: what is not UTF-8 in them is replaced.
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
    : out_(file, std::ios::app | std::ios::binary), limits_(limits) {
  if (!out_) throw RuntimeError("cannot write '{}': {}", file.string(), std::strerror(errno));
  bytes_ = std::filesystem::file_size(file);
}

// A clock that was set back must not silence a process until it has caught up.
bool MetricsLog::Due(const MetricsMessage& message, const Last& last) const {
  if (bytes_ < limits_.burst_bytes || message.pid != last.pid || message.state == "stopping") {
    return true;
  }
  size_t round = 0;  // a line of each process
  for (const auto& [process, line] : last_) round += line.bytes;
  const double interval =
      3600 * static_cast<double>(round) / static_cast<double>(limits_.bytes_per_hour);
  const double since = message.time - last.time;
  return since < 0 || since >= interval;
}

bool MetricsLog::Write(const MetricsMessage& message) {
  Last& last = last_[{message.role, message.id}];
  if (!Due(message, last)) {
    ++left_out_;
    return true;
  }
  const std::string text = Line(message);
  const bool room = bytes_ + text.size() <= limits_.most_bytes;
  if (room && out_ << text << std::flush) {
    bytes_ += text.size();
    last = {message.time, message.pid, text.size()};
    return true;
  }
  ++left_out_;
  return std::exchange(failed_, true);
}

}  // namespace shoal::launch
