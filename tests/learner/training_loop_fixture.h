// SPDX-License-Identifier: Apache-2.0
// The training loop with a real, small agent. The test simulates batches, readers and the
// coordinator.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/run_folder/run_file_names.h"
#include "learner/agent/algorithms.h"
#include "learner/agent/replicated_agent.h"
#include "learner/agent/wrapped_agent.h"
#include "learner/training_loop.h"
#include "tests/learner/engine/deferring_engine.h"
#include "tests/learner/played_parts.h"
#include "tests/learner/training_fixture.h"
#include "tests/support/temporary_folder.h"

namespace shoal::learner {

inline constexpr uint64_t kTrainingSession = 77;

// An agent whose updates take longer than the second between two reports.
class SlowAgent final : public WrappedAgent {
 public:
  explicit SlowAgent(std::unique_ptr<Agent> agent) { agent_ = std::move(agent); }

  std::vector<UpdateOutcome> Submit(const BatchView& batch,
                                    const OnStageEnd& on_stage_end) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    return WrappedAgent::Submit(batch, on_stage_end);
  }
};

class TrainingLoopTest : public testing::Test {
 protected:
  // Plays one learner process, from the newest checkpoint until `stop_after` batches have been
  // consumed.
  TrainingLoop::End Train(uint64_t stop_after,
                          const std::function<void(PlayedBatches&)>& script = {}) {
    sink_.spec_hash = run_.spec.Hash();
    sink_.session = kTrainingSession;
    std::unique_ptr<Agent> agent = NewAgent();
    if (slow_) agent = std::make_unique<SlowAgent>(std::move(agent));
    CheckpointStore checkpoints(folder_.path(), run_);
    std::optional<CheckpointState> restored;
    if (const auto checkpoint = checkpoints.RestoreNewest()) {
      agent->Restore(checkpoint->tensors, "test");
      restored = checkpoint->state;
    }
    PlayedBatches batches(run_, agent->updates() + 1);
    batches.last_request = stop_after;
    batches.before = [&](uint64_t request) {
      if (request > stop_after) Say(RunState::kStopping);
    };
    if (script) script(batches);
    UpdatePage page(folder_.path(), agent->updates());
    TrainingLoop loop({.run = run_,
                       .name = {"learner", 0},
                       .precision = precision_,
                       .session = kTrainingSession,
                       .agent = *agent,
                       .batches = batches,
                       .sink = sink_,
                       .checkpoints = checkpoints,
                       .pending_evaluations = pending_,
                       .control = control_,
                       .update_page = page,
                       .drain_idle = std::chrono::milliseconds(20),
                       .resize = resize_},
                      restored);
    const TrainingLoop::End end = loop.Run();
    given_ = batches.given();
    updates_ = agent->updates();
    return end;
  }

  // One whose engine has up to `delay_` updates in flight.
  std::unique_ptr<Agent> NewAgent() {
    if (delay_ == 0) return MakeAgent(run_.config, run_.spec, precision_);
    return MakeReplicatedAgent(run_.config, precision_, /*replicas=*/1, [this](Engine* engine) {
      return FindAlgorithm(run_.config.learner.algorithm)
          .make(run_.config, run_.spec, &engines_.emplace_back(engine, delay_));
    });
  }

  void Say(RunState state) {
    control_.OnMessage({.epoch = ++epoch_, .state = state, .time = 0}, Now());
  }
  void Set(const std::string& key, double value) {
    ControlMessage message{.epoch = ++epoch_, .state = RunState::kRunning, .time = 0};
    message.setting_names = {key};
    message.setting_values = {value};
    control_.OnMessage(message, Now());
  }

  // A metric of the last report.
  double Figure(const std::string& name) const {
    const MetricsMessage& report = sink_.reports.back();
    const auto at = std::ranges::find(report.names, name);
    EXPECT_NE(at, report.names.end()) << name;
    return at == report.names.end() ? -1 : report.values[size_t(at - report.names.begin())];
  }

  // Updates that the page counts, which it then forgets.
  uint64_t TakeCounted() const {
    const uint64_t counted = UpdatePage(folder_.path(), 0).lost();
    std::filesystem::remove(folder_.path() / kUpdatePageFile);
    return counted;
  }
  std::set<std::string> Checkpoints() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "checkpoints")) {
      names.insert(entry.path().filename());
    }
    return names;
  }
  std::filesystem::path Checkpoint(const std::string& name) const {
    return folder_.path() / "checkpoints" / name;
  }

  const TemporaryFolder folder_;
  RunConfig run_ = SmallRun();  // weights every 5 updates
  nn::Precision precision_ = nn::Precision::kF32;
  KeptMessages sink_;
  PendingEvaluations pending_;
  ControlState control_{Now()};
  uint64_t epoch_ = 0;
  uint64_t given_ = 0, updates_ = 0;
  bool slow_ = false;
  size_t delay_ = 0;
  std::deque<DeferringEngine> engines_;
  std::function<int(int threads)> resize_;
};

}  // namespace shoal::learner
