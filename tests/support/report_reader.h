// SPDX-License-Identifier: Apache-2.0
// Follows a run's metrics.jsonl: the newest report of each process.
#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "common/base/clock.h"

namespace shoal {

class ReportReader {
 public:
  explicit ReportReader(const std::filesystem::path& run) : file_(run / "metrics.jsonl") {}

  // Skips the present content of the file: reports of an earlier session of the run.
  void SkipOld() {
    std::error_code none_yet;
    const auto size = std::filesystem::file_size(file_, none_yet);
    if (!none_yet) offset_ = static_cast<std::streamoff>(size);
  }

  // The newest report of the role's process `id`; null if there is no report yet.
  const nlohmann::json& Last(const std::string& role, int id = 0) {
    ReadOn();
    return last_[{role, id}];
  }
  // Waits for the first report of the process; null at the deadline.
  nlohmann::json Await(const std::string& role, int id = 0) {
    return WaitFor(
        role, [](const auto&) { return true; }, std::chrono::seconds(60), id);
  }
  // Polls until there is a report and done(newest report) is true. Returns the report; null at the
  // deadline.
  template <class Done>
  nlohmann::json WaitFor(const std::string& role, Done done,
                         std::chrono::seconds deadline = std::chrono::seconds(60), int id = 0) {
    const SteadyTime end = Now() + deadline;
    do {
      const nlohmann::json& report = Last(role, id);
      if (!report.is_null() && done(report)) return report;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    } while (Now() < end);
    return {};
  }

 private:
  void ReadOn() {
    std::ifstream in(file_);
    in.seekg(offset_);
    for (std::string line; std::getline(in, line) && !in.eof();) {
      offset_ = in.tellg();
      nlohmann::json report = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
      if (!report.is_object() || !report.contains("role") || !report.contains("id")) continue;
      const std::pair key{report["role"].get<std::string>(), report["id"].get<int>()};
      last_[key] = std::move(report);
    }
  }

  const std::filesystem::path file_;
  std::streamoff offset_ = 0;
  std::map<std::pair<std::string, int>, nlohmann::json> last_;
};

}  // namespace shoal
