// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/parity_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/check.h"

namespace shoal::worlds {

void ReplayReport::Compare(const std::string& quantity, const std::string& unit, double judged_by,
                           std::span<const double> ours, std::span<const double> theirs, int step) {
  CHECK(ours.size() == theirs.size()) << quantity << ": " << ours.size() << ", " << theirs.size();
  auto found = std::find_if(deviations.begin(), deviations.end(),
                            [&](const Deviation& known) { return known.quantity == quantity; });
  if (found == deviations.end()) {
    found = deviations.insert(
        found, Deviation{.quantity = quantity, .unit = unit, .tolerance = judged_by});
  }
  for (size_t i = 0; i < ours.size(); ++i) {
    const double difference = std::fabs(ours[i] - theirs[i]);
    if (difference <= found->largest) continue;
    found->largest = difference;
    found->at_step = step;
  }
}

void ReplayReport::Judge() {
  passed = reward_mismatches == 0 && success_mismatches == 0 && termination_mismatches == 0 &&
           std::all_of(deviations.begin(), deviations.end(),
                       [](const Deviation& deviation) { return deviation.Passed(); });
}

nlohmann::ordered_json ToJson(const ReplayReport& report) {
  nlohmann::ordered_json quantities = nlohmann::ordered_json::array();
  for (const Deviation& deviation : report.deviations) {
    nlohmann::ordered_json quantity{
        {"quantity", deviation.quantity}, {"unit", deviation.unit}, {"largest", deviation.largest},
        {"at_step", deviation.at_step},   {"tolerance", nullptr},   {"passed", deviation.Passed()}};
    if (deviation.tolerance > 0) quantity["tolerance"] = deviation.tolerance;
    quantities.push_back(quantity);
  }
  nlohmann::ordered_json json{{"schema", "shoal-parity-1"},
                              {"file", report.file},
                              {"environment", report.environment},
                              {"sequence", report.sequence},
                              {"physics", report.physics},
                              {"model", nullptr},
                              {"steps", report.steps},
                              {"tolerance", report.tolerance},
                              {"deviations", quantities},
                              {"reward_mismatches", report.reward_mismatches},
                              {"success_mismatches", report.success_mismatches},
                              {"contact_mismatches", report.contact_mismatches},
                              {"termination_mismatches", report.termination_mismatches},
                              {"chaotic_from", nullptr},
                              {"passed", report.passed}};
  if (!report.model.empty()) json["model"] = report.model;
  if (report.chaotic_from > 0) json["chaotic_from"] = report.chaotic_from;
  return json;
}

std::string ToText(const ReplayReport& report) {
  std::string text = fmt::format("{} {}, {} steps, physics {}\n", report.environment,
                                 report.sequence, report.steps, report.physics);
  for (const Deviation& deviation : report.deviations) {
    const std::string verdict =
        deviation.tolerance == 0
            ? ""
            : fmt::format("  {} {:.0e}", deviation.Passed() ? "within" : "BEYOND",
                          deviation.tolerance);
    text += fmt::format("  {:<24} {:9.2e} {:<8} at step {:<3}{}\n", deviation.quantity,
                        deviation.largest, deviation.unit, deviation.at_step, verdict);
  }
  if (report.chaotic_from > 0) {
    text +=
        fmt::format("  object not judged from step {} on, where it is hit\n", report.chaotic_from);
  }
  text +=
      fmt::format("  {} reward, {} success, {} contact and {} termination mismatches\n{}\n",
                  report.reward_mismatches, report.success_mismatches, report.contact_mismatches,
                  report.termination_mismatches, report.passed ? "passed" : "FAILED");
  return text;
}

}  // namespace shoal::worlds
