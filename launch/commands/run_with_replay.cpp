// SPDX-License-Identifier: Apache-2.0
#include "launch/commands/run_with_replay.h"

#include "common/base/error.h"
#include "common/config/on_policy.h"
#include "common/config/run_files.h"

namespace shoal::launch {

RunConfig ReadRunWithReplay(const std::filesystem::path& run) {
  RunConfig config = ReadRunConfig(run);
  if (LearnsOnPolicy(config.config)) {
    throw UsageError("'{}' has no replay: learner.algorithm = {} learns from rollouts",
                     run.string(), config.config.learner.algorithm);
  }
  return config;
}

}  // namespace shoal::launch
