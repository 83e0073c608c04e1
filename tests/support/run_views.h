// SPDX-License-Identifier: Apache-2.0
// Views of a test's run, read with `shoal`.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "common/base/clock.h"
#include "tests/support/training_run.h"

namespace shoal {

// Runs `shoal` with these words, and with --run-dir set to the folder of the test's run.
inline ProgramResult RunShoal(const TrainingRun& run, std::vector<std::string> words,
                              std::chrono::seconds deadline = std::chrono::seconds(90)) {
  words.insert(words.begin(), "shoal");
  words.push_back("--run-dir");
  words.push_back(run.parent().string());
  return RunProgram(words, deadline);
}

// Polls `shoal top --once --json` until done(view) is true. At the deadline, fails the test and
// returns null.
template <class Done>
nlohmann::json WaitForView(const TrainingRun& run, Done done,
                           std::chrono::seconds deadline = std::chrono::seconds(90)) {
  const SteadyTime end = Now() + deadline;
  ProgramResult top;
  while (Now() < end) {
    top = RunShoal(run, {"top", "--once", "--json"});
    const auto view = nlohmann::json::parse(top.out, nullptr, /*allow_exceptions=*/false);
    if (ExitCode(top) == 0 && view.is_object() && done(view)) return view;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  ADD_FAILURE() << "no such view within " << deadline.count() << " s; the last: " << top.out
                << top.err;
  return {};
}

// The report of the role's process `id` in a view; null if there is none.
inline nlohmann::json ProcessOf(const nlohmann::json& view, const std::string& role, int id = 0) {
  for (const nlohmann::json& process : view.at("processes")) {
    if (process.at("role") == role && process.at("id") == id) return process;
  }
  return {};
}

// Condition for WaitForView: more than 50 updates have been made, and the replay reports the policy
// lag.
inline bool Learns(const nlohmann::json& view) {
  const nlohmann::json learner = ProcessOf(view, "learner");
  return learner.is_object() && learner.value("updates", 0.0) > 50 &&
         ProcessOf(view, "replay").contains("policy_lag_p50");
}

}  // namespace shoal
