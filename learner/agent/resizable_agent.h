// SPDX-License-Identifier: Apache-2.0
// An agent whose number of threads may change between two updates. For a change, a new agent is
// made, and the tensors of the old agent are restored into it, like those of a checkpoint. Tensors
// do not depend on the number of threads.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "learner/agent/wrapped_agent.h"

namespace shoal::learner {

class ResizableAgent final : public WrappedAgent {
 public:
  // Makes the agent for `threads` threads; may throw Error.
  using Make = std::function<std::unique_ptr<Agent>(int threads)>;

  ResizableAgent(Make make, int threads) : make_(std::move(make)), threads_(threads) {
    agent_ = make_(threads);
  }

  // Changes the number of threads. No update may be in flight. Takes as long as making an agent.
  // Throws the errors of `make`; the agent is then unchanged.
  void Resize(int threads);
  int threads() const { return threads_; }

 private:
  const Make make_;
  int threads_;
};

}  // namespace shoal::learner
