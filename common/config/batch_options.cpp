// SPDX-License-Identifier: Apache-2.0
#include "common/config/batch_options.h"

#include <utility>

#include "common/config/priorities.h"
#include "common/config/privileged_blocks.h"
#include "common/config/sequences.h"

namespace shoal {

BatchOptions BatchOptionsOf(const RunConfig& run) {
  std::vector<std::string> privileged = PrivilegedBlocksOf(run.config, run.spec).all;
  return {.batch = run.config.learner.batch,
          .copies = run.config.replay.copies,
          .target_shifts = run.config.replay.target_shifts,
          .critic_shifts = run.config.replay.critic_shifts,
          .n_step = run.config.replay.n_step,
          .discount = run.config.learner.discount,
          .horizon = HorizonOf(run.config),
          .probabilities = HasPriorities(run.config.replay),
          .privileged = std::move(privileged)};
}

BatchSchema BatchSchemaOf(const RunConfig& run) { return {run.spec, BatchOptionsOf(run)}; }

}  // namespace shoal
