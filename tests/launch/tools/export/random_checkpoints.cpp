// SPDX-License-Identifier: Apache-2.0
// Writes a checkpoint of every algorithm and encoder, trained for three updates on random numbers.
// tests/comparison/onnx_actions.py and sb3_policy.py compare the results of `shoal export` in other
// programs.
//
// usage: random-checkpoints FOLDER [TEXT]
//   FOLDER/ALGORITHM-ENCODER/checkpoints/step_N. ENCODER is "state" without pixels, "sb3" or
//   "sb3-state" for networks that Stable-Baselines3 has (encoder nature alone, or vectors). SAC
//   also has "asymmetric" (a critic of blocks), "taught" (sac.aux), "separate" (an encoder of the
//   actor's own) and "environment" (vectors of an environment in Python). TEXT selects the
//   checkpoints whose ALGORITHM-ENCODER contains it.
#include <fmt/core.h>

#include <filesystem>

#include "actor/hosted/hosted_spec.h"
#include "common/base/main_guard.h"
#include "common/nn/encoders/encoder_kind.h"
#include "tests/common/policy/checkpoint_fixture.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

void Write(const std::string& name, const RunConfig& run, const fs::path& folder) {
  fs::create_directories(folder / name);
  fmt::print("{}\n", policy::WriteCheckpointOf(run, folder / name).string());
}

// The network of Stable-Baselines3's MlpPolicy or CnnPolicy.
RunConfig Sb3Run(const std::string& algorithm, bool pixels) {
  RunConfig run = policy::SmallRun(algorithm, pixels);
  run.config.network.layer_norm = false;
  run.config.network.log_std = "clamped";
  if (algorithm == "ppo") run.config.network.activation = "tanh";
  if (!pixels) return run;
  run.config.network.encoder = "nature";
  run.config.network.trunk = "auto";
  run.config.network.filters.clear();
  run.config.network.strides.clear();
  run.config.learner.normalise_vectors = false;
  run.config.observation.proprioception = false;
  run.spec.height = run.spec.width = 84;
  for (BlockSpec& block : run.spec.blocks) block.observed = false;
  return run;
}

// Two blocks and two actions with bounds of their own.
RunConfig EnvironmentRun() {
  RunConfig run = policy::SmallRun("sac", /*pixels=*/false);
  run.config.env.id = "Fake-v0";
  run.spec = hosted::SpecOf(
      {.id = "Fake-v0",
       .task = "Fake-v0",
       .episode_steps = 50,
       .action = {.name = "action", .shape = {2}, .low = {-2, 0}, .high = {2, 10}},
       .observation = {{.name = "state",
                        .shape = {3},
                        .type = tasks::ElementType::kFloat64,
                        .low = {-5},
                        .high = {5}},
                       {.name = "robot.arm", .shape = {2, 2}, .low = {-9}, .high = {9}}}},
      run.config);
  return run;
}

int Main(const fs::path& folder, const std::string& text) {
  const auto write = [&](const std::string& name, const RunConfig& run) {
    if (name.find(text) != std::string::npos) Write(name, run, folder);
  };
  for (const std::string algorithm : {"sac", "td3", "ddpg", "ppo"}) {
    write(algorithm + "-state", policy::SmallRun(algorithm, /*pixels=*/false));
    write(algorithm + "-sb3-state", Sb3Run(algorithm, /*pixels=*/false));
    write(algorithm + "-sb3", Sb3Run(algorithm, /*pixels=*/true));
    for (const nn::EncoderKind& kind : nn::EncoderKinds()) {
      RunConfig run = policy::SmallRun(algorithm, /*pixels=*/true);
      run.config.network.encoder = kind.name;
      run.config.network.filters.clear();
      run.config.network.strides.clear();
      run.spec.height = run.spec.width = 84;
      write(algorithm + "-" + std::string(kind.name), run);
    }
  }
  RunConfig run = policy::SmallRun("sac", /*pixels=*/true);
  run.config.sac.critic_blocks = true;
  write("sac-asymmetric", run);
  run = policy::SmallRun("sac", /*pixels=*/true);
  run.config.sac.aux = {"hidden"};
  write("sac-taught", run);
  run = policy::SmallRun("sac", /*pixels=*/true);
  run.config.network.encoders = "separate";
  run.config.network.target_encoder = true;
  write("sac-separate", run);
  write("sac-environment", EnvironmentRun());
  return 0;
}

}  // namespace
}  // namespace shoal

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    fmt::print(stderr, "usage: random-checkpoints FOLDER [TEXT]\n");
    return 2;
  }
  return shoal::GuardMain("random-checkpoints",
                          [&] { return shoal::Main(argv[1], argc == 3 ? argv[2] : ""); });
}
