// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/resizable_agent.h"

#include <fmt/core.h>

#include <utility>

namespace shoal::learner {

void ResizableAgent::Resize(int threads) {
  if (threads == threads_) return;
  std::unique_ptr<Agent> agent = make_(threads);
  agent->Restore(agent_->AllTensors(), fmt::format("the agent of {} threads", threads_));
  agent_ = std::move(agent);
  threads_ = threads;
}

}  // namespace shoal::learner
