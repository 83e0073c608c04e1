// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/environments.h"

#include "common/base/error.h"
#include "common/config/spec_mismatch.h"

namespace shoal::actor {

std::vector<std::unique_ptr<worlds::Environment>> MakeEnvironments(const RunConfig& run,
                                                                   int count) {
  std::shared_ptr<worlds::RenderContext> render;
  if (run.config.observation.pixels) {
    render = worlds::MakeRenderContext(run.config.observation);
  }
  std::vector<std::unique_ptr<worlds::Environment>> environments;
  for (int i = 0; i < count; ++i) {
    environments.push_back(worlds::MakeEnvironment(run.config, render));
    const ObservationSpec& spec = environments.back()->spec();
    if (spec.Hash() != run.spec.Hash()) {
      throw RuntimeError("{}", SpecMismatch(run, spec));
    }
  }
  return environments;
}

}  // namespace shoal::actor
