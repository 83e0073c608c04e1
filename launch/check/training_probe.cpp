// SPDX-License-Identifier: Apache-2.0
#include "launch/check/training_probe.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "actor/worlds/environment.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/nn/precision.h"
#include "common/run_folder/run_file_names.h"
#include "launch/check/local_collection.h"
#include "learner/agent/algorithms.h"
#include "learner/checkpoint.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr int kEnvs = 2;
constexpr int64_t kCapacity = 512;  // records
constexpr uint64_t kEnvSteps = 120;

RunConfig SmallRun(Config config) {
  config.run_name = "check";
  config.actors = 1;
  config.envs_per_actor = kEnvs;
  config.replay.storage = "memory";
  config.replay.capacity = kCapacity;
  config.replay.min_size = 64;
  config.replay.samples_per_insert = Schedule::Constant(0);
  std::shared_ptr<worlds::RenderContext> render;
  if (config.observation.pixels) render = worlds::MakeRenderContext(config.observation);
  return {config, worlds::MakeEnvironment(config, render)->spec()};
}

bool Same(const nn::TensorMap& a, const nn::TensorMap& b) {
  return a.size() == b.size() && std::ranges::all_of(a, [&](const auto& entry) {
           const auto other = b.find(entry.first);
           return other != b.end() && other->second.data == entry.second.data;
         });
}

uint64_t BytesBelow(const fs::path& folder) {
  uint64_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  return bytes;
}

// Writes the agent, restores another one from it and lets both do the same update.
void CompareRestored(const RunConfig& run, nn::Precision precision, const BatchView& batch,
                     const fs::path& folder, learner::Agent* agent, TrainingProbe* probe) {
  CheckpointState state;
  state.updates = agent->updates();
  state.env_steps = probe->env_steps;
  state.learner_session = 1;
  state.spec_hash = run.spec.Hash();
  state.precision = nn::ToString(precision);
  state.algorithm = run.config.learner.algorithm;
  fs::create_directories(folder);
  learner::WriteCheckpoint(folder, state, agent->AllTensors(), agent->AveragedPolicyTensors(), run,
                           nlohmann::ordered_json::object());
  probe->checkpoint_bytes = BytesBelow(folder);
  const learner::Checkpoint checkpoint =
      learner::ReadCheckpoint(folder / CheckpointName(state.updates), state.spec_hash);
  Config other = run.config;
  other.seed += 1;  // so that equal tensors can only come from the checkpoint
  const auto restored = learner::MakeAgent(other, run.spec, precision);
  restored->Restore(checkpoint.tensors, checkpoint.folder.string());
  probe->restored = checkpoint.state == state && Same(restored->AllTensors(), agent->AllTensors());

  const auto again = learner::MakeAgent(run.config, run.spec, precision);
  again->Restore(checkpoint.tensors, checkpoint.folder.string());
  again->Update(batch);
  agent->Update(batch);
  probe->continued = Same(again->AllTensors(), agent->AllTensors());
}

}  // namespace

TrainingProbe ProbeTraining(const Config& config, const fs::path& folder, int updates) {
  const RunConfig run = SmallRun(config);
  TrainingProbe probe;
  LocalCollection collection(run, folder);
  SteadyTime start = Now();
  collection.Collect(kEnvSteps);
  probe.env_steps = collection.rollout().env_steps();
  probe.env_steps_per_second = static_cast<double>(probe.env_steps) / SecondsSince(start);

  const nn::Precision precision =
      nn::ChoosePrecision(run.config.learner.precision, run.spec.HasPixels());
  const auto agent = learner::MakeAgent(run.config, run.spec, precision);
  const nn::TensorMap fresh = agent->PolicyTensors();
  probe.finite = true;
  start = Now();
  for (int i = 0; i < updates; ++i) {
    probe.finite = agent->Update(collection.Draw()).finite && probe.finite;
  }
  probe.updates = agent->updates();
  probe.updates_per_second = static_cast<double>(updates) / SecondsSince(start);
  probe.moved = !Same(fresh, agent->PolicyTensors());
  CompareRestored(run, precision, collection.Draw(), folder / kCheckpointFolder, agent.get(),
                  &probe);
  return probe;
}

CheckLine JudgeTraining(const TrainingProbe& probe) {
  CheckLine line{
      "training", Verdict::kOk,
      fmt::format("{} env steps at {:.0f}/s, {} updates at {:.1f}/s on one thread, "
                  "checkpoint of {:.1f} MB read back bit by bit",
                  probe.env_steps, probe.env_steps_per_second, probe.updates,
                  probe.updates_per_second, static_cast<double>(probe.checkpoint_bytes) / 1e6),
      ""};
  const char* fault = !probe.finite      ? "an update was not finite"
                      : !probe.moved     ? "updates left the parameters as they were"
                      : !probe.restored  ? "a checkpoint read back is not what was written"
                      : !probe.continued ? "a restored learner computes different updates"
                                         : nullptr;
  if (fault != nullptr) {
    line.verdict = Verdict::kFail;
    line.finding = fault;
    line.advice =
        "memory, disk or CPU cannot be trusted, or the build is broken: run the tests "
        "(./run test)";
  }
  return line;
}

}  // namespace shoal::launch
