// SPDX-License-Identifier: Apache-2.0
#include "common/base/log.h"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <vector>

#include "common/base/error.h"
#include "common/base/thread_group.h"

namespace shoal::log {
namespace {

constexpr char kPattern[] = "%Y-%m-%d %H:%M:%S.%e %n %l: %v";

std::shared_ptr<spdlog::logger>& ProcessLogger() {
  static auto logger =
      std::make_shared<spdlog::logger>("shoal", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  return logger;
}

spdlog::sink_ptr OpenSink(const std::string& file) {
  try {
    return std::make_shared<spdlog::sinks::basic_file_sink_mt>(file);
  } catch (const spdlog::spdlog_ex& e) {
    throw RuntimeError("log file '{}': {}", file, e.what());
  }
}

}  // namespace

class File {
 public:
  File(const std::string& name, const std::string& file)
      : logger_(name, OpenSink(file)), raw_("", OpenSink(file)) {
    logger_.set_pattern(kPattern);
    logger_.flush_on(spdlog::level::info);
    raw_.set_pattern("%v");
    raw_.flush_on(spdlog::level::info);
  }
  spdlog::logger& logger() { return logger_; }
  void WriteRaw(const std::string& line) { raw_.info(line); }

 private:
  spdlog::logger logger_;
  spdlog::logger raw_;  // has its own sink, because a pattern belongs to a sink
};

namespace {

spdlog::logger& Logger() {
  ThreadGroup* group = ThreadGroup::Current();
  return group != nullptr ? group->log().logger() : *ProcessLogger();
}

}  // namespace

std::shared_ptr<File> OpenFile(const std::string& name, const std::string& file) {
  return std::make_shared<File>(name, file);
}

void WriteRaw(File& log, const std::string& line) { log.WriteRaw(line); }

void Start(const std::string& name, const std::string& file) {
  std::vector<spdlog::sink_ptr> sinks{std::make_shared<spdlog::sinks::stderr_sink_mt>()};
  if (!file.empty()) {
    sinks.push_back(OpenSink(file));
  }
  ProcessLogger() = std::make_shared<spdlog::logger>(name, sinks.begin(), sinks.end());
  ProcessLogger()->set_pattern(kPattern);
  ProcessLogger()->flush_on(spdlog::level::info);
}

void WriteInfo(const std::string& line) { Logger().info(line); }
void WriteWarning(const std::string& line) { Logger().warn(line); }
void WriteError(const std::string& line) { Logger().error(line); }

}  // namespace shoal::log
