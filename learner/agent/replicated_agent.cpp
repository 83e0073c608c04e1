// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/replicated_agent.h"

#include <algorithm>
#include <deque>
#include <exception>
#include <vector>

#include "common/base/check.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/parallel.h"
#include "common/nn/replica.h"
#include "common/nn/team.h"
#include "learner/engine/cpu_engine.h"

namespace shoal::learner {
namespace {

class ReplicatedAgent final : public Agent {
 public:
  ReplicatedAgent(const Config& config, nn::Precision precision, int replicas,
                  const MakeReplica& make)
      : exchange_(replicas, config.learner.batch, config.replay.copies), team_(replicas) {
    for (int rank = 0; rank < replicas; ++rank) {
      replicas_.push_back(replicas == 1 ? nn::Replica() : nn::Replica(&exchange_, rank));
      agents_.push_back(MakeOne(config, precision, rank, make));
    }
  }

  // Reports the stages of the first replica, which runs on the caller's thread.
  UpdateOutcome Update(const BatchView& batch, const OnStageEnd& on_stage_end) override {
    std::vector<UpdateOutcome> outcomes(agents_.size());
    exchange_.SetPatient(!team_.crowded());
    team_.Run([&](int rank) {
      outcomes[size_t(rank)] = agents_[size_t(rank)]->Update(
          batch, rank == 0 ? on_stage_end : [](UpdateStage) {});
    });
    for (const UpdateOutcome& outcome : outcomes) {
      CHECK(outcome.finite == outcomes[0].finite) << "replicas disagree";
    }
    return std::move(outcomes[0]);
  }
  uint64_t updates() const override { return agents_[0]->updates(); }
  nn::TensorMap PolicyTensors() const override { return agents_[0]->PolicyTensors(); }
  nn::TensorMap AveragedPolicyTensors() const override {
    return agents_[0]->AveragedPolicyTensors();
  }
  nn::TensorMap AllTensors() const override { return agents_[0]->AllTensors(); }
  // The first replica refuses bad tensors before any replica changes.
  void Restore(const nn::TensorMap& tensors, const std::string& source) override {
    for (const auto& agent : agents_) agent->Restore(tensors, source);
  }

 private:
  // Makes a replica on the thread that will run it.
  std::unique_ptr<Agent> MakeOne(const Config& config, nn::Precision precision, int own,
                                 const MakeReplica& make) {
    std::unique_ptr<Agent> agent;
    std::exception_ptr error;
    team_.Run([&](int rank) {
      if (rank != own) return;
      try {
        nn::Replica* replica = &replicas_[size_t(rank)];
        const nn::ThreadScope scope(replica->threads());  // built for the threads that run it
        agent = make(&engines_.emplace_back(precision, config.learner.batch, replica));
      } catch (...) {
        error = std::current_exception();
      }
    });
    if (error) std::rethrow_exception(error);
    return agent;
  }

  nn::Exchange exchange_;
  std::deque<nn::Replica> replicas_;
  std::deque<CpuEngine> engines_;
  std::vector<std::unique_ptr<Agent>> agents_;
  nn::Team team_;
};

}  // namespace

std::unique_ptr<Agent> MakeReplicatedAgent(const Config& config, nn::Precision precision,
                                           int replicas, const MakeReplica& make) {
  return std::make_unique<ReplicatedAgent>(config, precision, replicas, make);
}

bool NormalisesOverBatch(const NetworkConfig& network, const ObservationSpec& spec) {
  return spec.HasPixels() &&
         std::ranges::any_of(nn::PlanEncoder(network, spec).layers(),
                             [](const nn::LayerPlan& layer) { return !layer.batch_norm.empty(); });
}

}  // namespace shoal::learner
