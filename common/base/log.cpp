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
      : sink_(OpenSink(file)), logger_(name, sink_) {
    logger_.set_pattern(kPattern);
    logger_.flush_on(spdlog::level::info);
  }
  spdlog::logger& logger() { return logger_; }
  void WriteRaw(const std::string& line) {
    spdlog::logger raw("", sink_);
    raw.set_pattern("%v");
    raw.info(line);
    raw.flush();
    logger_.set_pattern(kPattern);  // the pattern is the sink's
  }

 private:
  const spdlog::sink_ptr sink_;
  spdlog::logger logger_;
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
