// SPDX-License-Identifier: Apache-2.0
#include "launch/check/check_line.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/build_info.h"
#include "common/base/clock.h"

namespace shoal::launch {

const char* ToString(Verdict verdict) {
  switch (verdict) {
    case Verdict::kOk:
      return "OK";
    case Verdict::kWarn:
      return "WARN";
    case Verdict::kFail:
      break;
  }
  return "FAIL";
}

CheckLine Guarded(const std::string& name, const std::string& advice,
                  const std::function<CheckLine()>& look) {
  try {
    return look();
  } catch (const std::exception& failure) {
    return {name, Verdict::kFail, failure.what(), advice};
  }
}

Verdict Worst(const std::vector<CheckLine>& lines) {
  Verdict worst = Verdict::kOk;
  for (const CheckLine& line : lines) worst = std::max(worst, line.verdict);
  return worst;
}

std::string ToText(const CheckLine& line) {
  std::string text =
      fmt::format("{:<5} {:<14} {}\n", ToString(line.verdict), line.name, line.finding);
  if (!line.advice.empty()) text += fmt::format("{:<20} -> {}\n", "", line.advice);
  return text;
}

nlohmann::ordered_json ToJson(const std::vector<CheckLine>& lines, double seconds,
                              const nlohmann::ordered_json& machine) {
  nlohmann::ordered_json checks = nlohmann::ordered_json::array();
  for (const CheckLine& line : lines) {
    checks.push_back({{"name", line.name},
                      {"verdict", ToString(line.verdict)},
                      {"finding", line.finding},
                      {"advice", line.advice}});
  }
  return {{"schema", "shoal-check-1"}, {"verdict", ToString(Worst(lines))},
          {"seconds", seconds},        {"checks", checks},
          {"machine", machine},        {"commit", BuildCommit()},
          {"created", UtcTimestamp()}};
}

}  // namespace shoal::launch
