// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/run_log.h"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "common/base/bounded_json.h"
#include "common/base/clock.h"
#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/base/file_lock.h"
#include "common/base/files.h"

namespace shoal::launch {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

std::string Line(const ordered_json& object) {
  return object.dump(-1, ' ', /*ensure_ascii=*/false, ordered_json::error_handler_t::replace);
}

void Count(const json& event, std::map<std::string, LoggedRun>* runs) {
  LoggedRun& run = (*runs)[event.at("run").get<std::string>()];
  if (event.at("event") == "started") {
    ++run.starts;
    run.most_jobs = std::max(run.most_jobs, event.at("jobs").get<int>());
    event.at("cores").get_to(run.cores);
    run.ending.reset();
    return;
  }
  RunEnding ending;
  event.at("run").get_to(ending.run);
  event.at("by_signal").get_to(ending.by_signal);
  event.at("code").get_to(ending.code);
  event.at("stopped").get_to(ending.stopped);
  event.at("problem").get_to(ending.problem);
  run.ending = std::move(ending);
}

}  // namespace

void RunLog::Write(const RunStart& start) const {
  Append(Line({{"time", UtcTimestamp()},
               {"event", "started"},
               {"run", start.run},
               {"resumed", start.resumed},
               {"jobs", start.jobs},
               {"cores", start.cores}}));
}

void RunLog::Write(const RunEnding& ending) const {
  Append(Line({{"time", UtcTimestamp()},
               {"event", "ended"},
               {"run", ending.run},
               {"by_signal", ending.by_signal},
               {"code", ending.code},
               {"stopped", ending.stopped},
               {"problem", ending.problem}}));
}

// If a kill cut the last line short, ends that line first, so that the new line stays separate.
void RunLog::Append(const std::string& line) const {
  const auto lock = FileLock::Take(file_, Holding::kAlone, kOthersWrite);
  if (!lock) throw RuntimeError("cannot write '{}': another process has locked it", file_.string());
  const Descriptor file(open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  if (file.get() < 0) {
    throw RuntimeError("cannot write '{}': {}", file_.string(), std::strerror(errno));
  }
  char last = '\n';
  const off_t size = lseek(file.get(), 0, SEEK_END);
  const bool cut = size > 0 && pread(file.get(), &last, 1, size - 1) == 1 && last != '\n';
  const std::string text = (cut ? "\n" : "") + line + "\n";
  if (write(file.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()) ||
      fdatasync(file.get()) != 0) {
    throw RuntimeError("cannot write '{}': {}", file_.string(), std::strerror(errno));
  }
}

std::map<std::string, LoggedRun> RunLog::Read() const {
  std::map<std::string, LoggedRun> runs;
  std::error_code error;
  if (!std::filesystem::exists(file_, error)) return runs;
  const std::string text = ReadFile(file_);
  size_t number = 0;
  for (size_t begin = 0; begin < text.size(); ++number) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    const json event = ParseBoundedJson<json>(line);
    if (event.is_discarded()) continue;  // a line cut short by a kill
    try {
      Count(event, &runs);
    } catch (const json::exception& e) {
      throw RuntimeError("{}: line {}: {}", file_.string(), number + 1, e.what());
    }
  }
  return runs;
}

}  // namespace shoal::launch
