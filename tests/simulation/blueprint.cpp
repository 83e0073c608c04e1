// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/blueprint.h"

#include <string>

#include "common/config/on_policy.h"
#include "launch/run/train_options.h"
#include "learner/agent/algorithms.h"

namespace shoal::simulation {
namespace {

// The spec that a task would have; no file is read for it.
ObservationSpec MadeUpSpec(const Config& config) {
  ObservationSpec spec;
  spec.task = config.task;
  spec.blocks = {{.name = "observation", .size = 10},
                 {.name = "achieved_goal", .size = 3},
                 {.name = "desired_goal", .size = 3}};
  spec.action_size = 4;
  spec.drawn_actions = LearnsOnPolicy(config);
  spec.model_fingerprint = "simulated";
  return spec;
}

Blueprint Make(const std::vector<std::string>& set) {
  launch::TrainOptions options;
  options.run_name = "run";
  options.set = {"actors=2",
                 "envs_per_actor=2",
                 "observation.pixels=false",
                 "observation.goal_mode=both",
                 "observation.proprioception=true",
                 "learner.threads=1",
                 "learner.batch=4",
                 "network.hidden=[8,8]",
                 "eval.episodes=2",
                 "eval.final_episodes=0",
                 "stop.success=2"};
  options.set.insert(options.set.end(), set.begin(), set.end());
  Blueprint blueprint{.run = {launch::ResolveConfig(options, 1), {}}, .policy = {}};
  blueprint.run.spec = MadeUpSpec(blueprint.run.config);
  blueprint.policy =
      learner::MakeAgent(blueprint.run.config, blueprint.run.spec, nn::Precision::kF32)
          ->PolicyTensors();
  return blueprint;
}

}  // namespace

std::vector<Blueprint> MakeBlueprints() {
  std::vector<Blueprint> blueprints;
  const std::vector<std::string> off_policy{"learner.checkpoint_period=25", "replay.min_size=50",
                                            "replay.shift_pad=0", "replay.keep=true"};
  // The learner sets the pace.
  std::vector<std::string> file = off_policy;
  for (const char* set : {"env_steps=400", "eval.interval=100", "replay.capacity=1000",
                          "replay.samples_per_insert=4"}) {
    file.emplace_back(set);
  }
  // The actors do, and overwrite the oldest records. Samples have priorities.
  std::vector<std::string> memory = off_policy;
  for (const char* set :
       {"env_steps=1000", "eval.interval=250", "replay.capacity=250", "replay.samples_per_insert=1",
        "replay.storage=memory", "replay.priorities=proportional"}) {
    memory.emplace_back(set);
  }
  blueprints.push_back(Make(file));
  blueprints.push_back(Make(memory));
  blueprints.push_back(Make({"env_steps=1000", "eval.interval=250", "learner.checkpoint_period=5",
                             "learner.algorithm=ppo", "ppo.rollout_steps=5", "ppo.epochs=1",
                             "ppo.rollout_deadline=3"}));
  return blueprints;
}

const Blueprint& BlueprintOf(uint64_t seed, const std::vector<Blueprint>& blueprints) {
  const uint64_t at = seed % 6;  // half of them with a file
  return blueprints.at(at < 3 ? 0 : at < 5 ? 1 : 2);
}

}  // namespace shoal::simulation
