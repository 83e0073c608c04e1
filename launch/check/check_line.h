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
  kWarn,  // training works, worse than it could
  kFail,  // training does not work
};
// "OK", "WARN", "FAIL"
const char* ToString(Verdict verdict);

struct CheckLine {
  std::string name;  // "cpu"
  Verdict verdict = Verdict::kOk;
  std::string finding;  // with figures and units
  std::string advice;   // what to do; empty when OK
};

// The line that `look` returns; what it throws becomes a FAIL named `name`, with `advice`.
CheckLine Guarded(const std::string& name, const std::string& advice,
                  const std::function<CheckLine()>& look);

// The worst of all; OK when there is none.
Verdict Worst(const std::vector<CheckLine>& lines);

// "OK    cpu           avx512_core_bf16, precision bf16", with the advice below where there is one.
std::string ToText(const CheckLine& line);
// Schema shoal-check-1: {schema, verdict, seconds, checks: [...], machine, commit, created}.
nlohmann::ordered_json ToJson(const std::vector<CheckLine>& lines, double seconds,
                              const nlohmann::ordered_json& machine);

}  // namespace shoal::launch
