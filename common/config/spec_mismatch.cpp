// SPDX-License-Identifier: Apache-2.0
#include "common/config/spec_mismatch.h"

#include <fmt/core.h>

namespace shoal {

std::string SpecMismatch(const RunConfig& run, const ObservationSpec& now) {
  ObservationSpec same_model = now;
  same_model.model_fingerprint = run.spec.model_fingerprint;
  if (same_model == run.spec) {
    const Config& config = run.config;
    const std::string what = !config.model.empty() ? fmt::format("model file '{}'", config.model)
                             : !config.task_library.empty()
                                 ? fmt::format("the model of task {} (task library '{}')",
                                               config.task, config.task_library)
                                 : fmt::format("the model of task {}", config.task);
    return fmt::format(
        "{} has changed since the run began: its numbers, its cameras or MuJoCo's version differ; "
        "expected those that the run was trained with",
        what);
  }
  return fmt::format("the run observed [{}], this program's actors would observe [{}]",
                     run.spec.Summary(), now.Summary());
}

}  // namespace shoal
