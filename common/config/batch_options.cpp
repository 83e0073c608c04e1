#include "common/config/batch_options.h"

namespace shoal {

BatchOptions BatchOptionsOf(const Config& config) {
  return {.batch = config.learner.batch,
          .copies = config.replay.copies,
          .n_step = config.replay.n_step,
          .discount = config.learner.discount};
}

BatchSchema BatchSchemaOf(const RunConfig& run) { return {run.spec, BatchOptionsOf(run.config)}; }

}  // namespace shoal
