// SPDX-License-Identifier: Apache-2.0
// A run without pixels that is small enough to train on in a unit test.
#pragma once

#include "common/config/run_config.h"

namespace shoal::learner {

// Batches of 4, one hidden layer of 8, observations of 3 floats, actions of 2.
inline RunConfig SmallRun() {
  RunConfig run;
  Config& config = run.config;
  config.run_name = "small";
  config.task = "Test";
  config.observation.pixels = false;
  config.observation.proprioception = true;
  config.network.hidden = {8};
  config.learner.batch = 4;
  config.learner.precision = "f32";
  config.learner.threads = 1;
  config.learner.request_credits = 2;
  config.learner.weights_period = 5;
  config.learner.checkpoint_period = 1'000'000;
  config.replay.min_size = 8;
  config.replay.samples_per_insert = Schedule::Constant(1);
  config.eval.interval = 1'000'000;
  run.spec.task = "Test";
  run.spec.blocks = {{"observation", 3}};
  run.spec.action_size = 2;
  run.spec.model_fingerprint = "none";
  return run;
}

}  // namespace shoal::learner
