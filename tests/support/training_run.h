// A small state-based training run of the real programs in a folder of its own, for integration
// tests.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/program.h"

namespace shoal {

class TrainingRun {
 public:
  // Arguments of `shoal train` for a short run from state; `more` is appended.
  std::vector<std::string> Command(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command{"shoal",      "train",
                                     "--preset",   "fetch-reach-state",
                                     "--run-name", "run",
                                     "--set",      "run_dir=" + folder_.path().string(),
                                     "--set",      "env_steps=4000",
                                     "--set",      "eval.interval=2000",
                                     "--set",      "eval.episodes=8",
                                     "--set",      "eval.final_episodes=8",
                                     "--set",      "replay.samples_per_insert=32",
                                     "--set",      "learner.threads=1",
                                     "--set",      "stop.success=2"};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }

  ProgramResult Train(const std::vector<std::string>& more = {},
                      std::chrono::seconds deadline = std::chrono::seconds(180)) const {
    return RunProgram(Command(more), deadline);
  }

  std::filesystem::path path() const { return folder_.path() / "run"; }
  std::filesystem::path parent() const { return folder_.path(); }
  nlohmann::json Json(const std::string& file) const {
    return nlohmann::json::parse(ReadFile(path() / file));
  }

 private:
  TemporaryFolder folder_;
};

// made = stored + lost with a killed process + rejected + after gap, exactly.
inline void ExpectBalanced(const nlohmann::json& meta) {
  const auto& a = meta.at("accounting");
  EXPECT_GT(a.at("made").get<int64_t>(), 0);
  EXPECT_EQ(a.at("made").get<int64_t>(),
            a.at("stored").get<int64_t>() + a.at("lost_with_process").get<int64_t>() +
                a.at("rejected").get<int64_t>() + a.at("after_gap").get<int64_t>())
      << a.dump();
}

}  // namespace shoal
