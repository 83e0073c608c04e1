// SPDX-License-Identifier: Apache-2.0
// A small state-based training run of the real programs in its own folder, for integration tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/program.h"

namespace shoal {

class TrainingRun {
 public:
  using Keys = std::map<std::string, std::string>;

  // Keys of a run from pixels that ends within seconds; `keys` override these keys.
  static Keys FromPixels(const Keys& keys = {}) {
    Keys all{{"observation.pixels", "true"},
             {"env_steps", "400"},
             {"eval.episodes", "2"},
             {"eval.final_episodes", "2"},
             {"eval.interval", "200"},
             {"learner.batch", "16"},
             {"replay.capacity", "2000"},
             {"replay.min_size", "100"},
             {"replay.samples_per_insert", "4"}};
    for (const auto& [key, value] : keys) all[key] = value;
    return all;
  }

  // Command line of `shoal train` for a short run. `flags` are appended. The run is from state
  // unless `flags` name another preset. `keys` override the keys of the run.
  std::vector<std::string> Command(const Keys& keys = {},
                                   const std::vector<std::string>& flags = {}) const {
    Keys all{{"env_steps", "4000"},        {"eval.episodes", "8"},
             {"eval.final_episodes", "8"}, {"eval.interval", "2000"},
             {"learner.threads", "1"},     {"replay.samples_per_insert", "32"},
             {"stop.success", "2"},        {"run_dir", folder_.path().string()}};
    for (const auto& [key, value] : keys) all[key] = value;
    const bool named = std::ranges::find(flags, "--preset") != flags.end();
    return CommandOf(named ? "" : "fetch-reach-state", all, flags);
  }

  // Command line of `shoal train` for a short run of PPO, which has no replay.
  std::vector<std::string> OnPolicyCommand(const Keys& keys = {},
                                           const std::vector<std::string>& flags = {}) const {
    Keys all{{"eval.episodes", "8"},    {"eval.final_episodes", "0"},
             {"eval.interval", "4000"}, {"ppo.rollout_steps", "128"},
             {"stop.success", "2"},     {"run_dir", folder_.path().string()}};
    for (const auto& [key, value] : keys) all[key] = value;
    return CommandOf("fetch-reach-ppo", all, flags);
  }

  ProgramResult Train(const Keys& keys = {}, const std::vector<std::string>& flags = {},
                      std::chrono::seconds deadline = std::chrono::seconds(180)) const {
    return RunProgram(Command(keys, flags), deadline);
  }

  std::filesystem::path path() const { return folder_.path() / "run"; }
  std::filesystem::path parent() const { return folder_.path(); }
  nlohmann::json Json(const std::string& file) const {
    return nlohmann::json::parse(ReadFile(path() / file));
  }

 private:
  // `preset` may be empty.
  static std::vector<std::string> CommandOf(const std::string& preset, const Keys& keys,
                                            const std::vector<std::string>& flags) {
    std::vector<std::string> command{"shoal", "train", "--run-name", "run"};
    if (!preset.empty()) command.insert(command.end(), {"--preset", preset});
    for (const auto& [key, value] : keys) {
      command.push_back("--set");
      command.push_back(key + "=" + value);
    }
    command.insert(command.end(), flags.begin(), flags.end());
    return command;
  }

  TemporaryFolder folder_;
};

// Content of learner.safetensors of the newest checkpoint.
inline std::string NewestLearnerState(const TrainingRun& run) {
  std::filesystem::path newest;
  for (const auto& entry : std::filesystem::directory_iterator(run.path() / "checkpoints")) {
    if (entry.path().filename() != "best") newest = std::max(newest, entry.path());
  }
  return ReadFile(newest / "learner.safetensors");
}

// Expects exactly made = stored + lost with a killed actor + lost with a replay + rejected + after
// gap + discarded.
inline void ExpectBalanced(const nlohmann::json& meta) {
  const auto& a = meta.at("accounting");
  EXPECT_GT(a.at("made").get<int64_t>(), 0);
  EXPECT_EQ(a.at("made").get<int64_t>(),
            a.at("stored").get<int64_t>() + a.at("lost_with_process").get<int64_t>() +
                a.at("lost_with_replay").get<int64_t>() + a.at("rejected").get<int64_t>() +
                a.at("after_gap").get<int64_t>() + a.at("discarded").get<int64_t>())
      << a.dump();
}

}  // namespace shoal
