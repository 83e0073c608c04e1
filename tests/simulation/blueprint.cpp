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
  options.set = {"env_steps=400",
                 "actors=2",
                 "envs_per_actor=2",
                 "observation.pixels=false",
                 "observation.goal_mode=both",
                 "observation.proprioception=true",
                 "learner.threads=1",
                 "learner.batch=4",
                 "network.hidden=[8,8]",
                 "eval.interval=100",
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
  std::vector<std::string> off_policy{"learner.checkpoint_period=10", "replay.capacity=1000",
                                      "replay.min_size=50",           "replay.samples_per_insert=4",
                                      "replay.shift_pad=0",           "replay.keep=true"};
  blueprints.push_back(Make(off_policy));
  off_policy.emplace_back("replay.storage=memory");
  blueprints.push_back(Make(off_policy));
  blueprints.push_back(Make({"learner.checkpoint_period=2", "learner.algorithm=ppo",
                             "ppo.rollout_steps=10", "ppo.epochs=1", "ppo.rollout_deadline=3"}));
  return blueprints;
}

const Blueprint& BlueprintOf(uint64_t seed, const std::vector<Blueprint>& blueprints) {
  const uint64_t at = seed % 6;  // half of them with a file
  return blueprints.at(at < 3 ? 0 : at < 5 ? 1 : 2);
}

}  // namespace shoal::simulation
