// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/evaluation_environments.h"

#include "actor/evaluation/other_task.h"
#include "actor/evaluation/world_view.h"

namespace shoal::actor {

EvaluationEnvironments WorldEnvironments() {
  return {.make = MakeEnvironments, .with_task = WithTask, .view = MakeWorldView};
}

}  // namespace shoal::actor
