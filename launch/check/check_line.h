// SPDX-License-Identifier: Apache-2.0
// One line of `shoal check`: subject, finding, advice.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace shoal::launch {

enum class Verdict {
  kOk,
  kWarn,  // training works, but not as well as possible
  kFail,  // training does not work
};
// "OK", "WARN", "FAIL"
const char* ToString(Verdict verdict);

struct CheckLine {
  std::string name;  // "cpu"
  Verdict verdict = Verdict::kOk;
  std::string finding;  // with numbers and units
  std::string advice;   // what to do; empty if OK
};

// Returns the line of `look`. If `look` throws, returns a FAIL line with `name` and `advice`.
CheckLine Guarded(const std::string& name, const std::string& advice,
                  const std::function<CheckLine()>& look);

// The worst verdict of all lines; OK if there are none.
Verdict Worst(const std::vector<CheckLine>& lines);

// "OK    cpu           avx512_core_bf16, precision bf16", followed by a line with the advice, if
// any.
std::string ToText(const CheckLine& line);
// Schema shoal-check-1: {schema, verdict, seconds, checks: [...], machine, commit, created}.
nlohmann::ordered_json ToJson(const std::vector<CheckLine>& lines, double seconds,
                              const nlohmann::ordered_json& machine);

}  // namespace shoal::launch
