// SPDX-License-Identifier: Apache-2.0
// Base class of an agent that owns another agent, passes calls to it and changes one thing.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "learner/agent/agent.h"

namespace shoal::learner {

class WrappedAgent : public Agent {
 public:
  std::vector<UpdateOutcome> Submit(const BatchView& batch,
                                    const OnStageEnd& on_stage_end) override {
    return agent_->Submit(batch, on_stage_end);
  }
  std::vector<UpdateOutcome> Finish() override { return agent_->Finish(); }
  uint64_t updates() const override { return agent_->updates(); }
  nn::TensorMap PolicyTensors() const override { return agent_->PolicyTensors(); }
  nn::PendingTensors CopyPolicyTensors() const override { return agent_->CopyPolicyTensors(); }
  nn::TensorMap AveragedPolicyTensors() const override { return agent_->AveragedPolicyTensors(); }
  nn::TensorMap AllTensors() const override { return agent_->AllTensors(); }
  void Restore(const nn::TensorMap& tensors, const std::string& source) override {
    agent_->Restore(tensors, source);
  }

 protected:
  // Set by the constructor of the derived class.
  std::unique_ptr<Agent> agent_;
};

}  // namespace shoal::learner
