#include "launch/metrics_log.h"

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "common/base/error.h"

namespace shoal::launch {

MetricsLog::MetricsLog(const std::filesystem::path& file, const MetricsLogLimits& limits)
    : out_(file, std::ios::app | std::ios::binary), limits_(limits) {
  if (!out_) throw RuntimeError("cannot write '{}': {}", file.string(), std::strerror(errno));
  bytes_ = std::filesystem::file_size(file);
}

bool MetricsLog::Write(const MetricsMessage& message) {
  double& last = last_[{message.role, message.id}];
  // A clock that was set back must not silence a process until it has caught up.
  const double since = message.time - last;
  if (bytes_ >= limits_.thin_bytes && since >= 0 && since < limits_.thin_seconds) {
    ++left_out_;
    return true;
  }
  nlohmann::ordered_json line{{"t", message.time},  {"role", message.role},
                              {"id", message.id},   {"host", message.host},
                              {"pid", message.pid}, {"state", message.state}};
  for (size_t i = 0; i < message.names.size() && i < message.values.size(); ++i) {
    line[message.names[i]] = message.values[i];  // JSON has null for what is not finite
  }
  const std::string text = line.dump() + "\n";
  const bool room = bytes_ + text.size() <= limits_.most_bytes;
  if (room && out_ << text << std::flush) {
    bytes_ += text.size();
    last = message.time;
    return true;
  }
  ++left_out_;
  return std::exchange(failed_, true);
}

}  // namespace shoal::launch
