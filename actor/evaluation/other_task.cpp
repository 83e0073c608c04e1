// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/other_task.h"

#include <memory>

#include "actor/worlds/environment.h"
#include "common/base/error.h"

namespace shoal::actor {
namespace {

// A spec with only what sets the sizes of a network's inputs and outputs: without task, model,
// cameras and unobserved blocks.
ObservationSpec Sizes(ObservationSpec spec) {
  spec.task.clear();
  spec.model_fingerprint.clear();
  spec.cameras.clear();
  std::erase_if(spec.blocks, [](const BlockSpec& block) { return !block.observed; });
  return spec;
}

}  // namespace

RunConfig WithTask(const RunConfig& run, const std::string& task) {
  RunConfig other = run;
  other.config.task = task;
  other.config.model.clear();
  other.config.randomization.body_mass.clear();
  std::shared_ptr<worlds::RenderContext> render;
  if (other.config.observation.pixels) {
    render = worlds::MakeRenderContext(other.config.observation);
  }
  other.spec = worlds::MakeEnvironment(other.config, render)->spec();
  if (Sizes(other.spec) != Sizes(run.spec)) {
    throw UsageError("the policy does not fit the task: it was trained on [{}], the task has [{}]",
                     run.spec.Summary(), other.spec.Summary());
  }
  return other;
}

}  // namespace shoal::actor
