// SPDX-License-Identifier: Apache-2.0
#include "common/base/log.h"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <vector>

#include "common/base/error.h"

namespace shoal::log {
namespace {

std::shared_ptr<spdlog::logger>& Logger() {
  static auto logger =
      std::make_shared<spdlog::logger>("shoal", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  return logger;
}

}  // namespace

void Start(const std::string& name, const std::string& file) {
  std::vector<spdlog::sink_ptr> sinks{std::make_shared<spdlog::sinks::stderr_sink_mt>()};
  if (!file.empty()) {
    try {
      sinks.push_back(std::make_shared<spdlog::sinks::basic_file_sink_mt>(file));
    } catch (const spdlog::spdlog_ex& e) {
      throw RuntimeError("log file '{}': {}", file, e.what());
    }
  }
  Logger() = std::make_shared<spdlog::logger>(name, sinks.begin(), sinks.end());
  Logger()->set_pattern("%Y-%m-%d %H:%M:%S.%e %n %l: %v");
  Logger()->flush_on(spdlog::level::info);
}

void WriteInfo(const std::string& line) { Logger()->info(line); }
void WriteWarning(const std::string& line) { Logger()->warn(line); }
void WriteError(const std::string& line) { Logger()->error(line); }

}  // namespace shoal::log
