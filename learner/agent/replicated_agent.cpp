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
  std::vector<UpdateOutcome> Submit(const BatchView& batch,
                                    const OnStageEnd& on_stage_end) override {
    ++in_flight_;
    exchange_.SetPatient(!team_.crowded());
    return OnEach([&](Agent& agent, int rank) {
      return agent.Submit(
          batch, rank == 0 ? on_stage_end : [](UpdateStage) {});
    });
  }
  std::vector<UpdateOutcome> Finish() override {
    if (in_flight_ == 0) return {};
    return OnEach([](Agent& agent, int) { return agent.Finish(); });
  }
  uint64_t updates() const override { return agents_[0]->updates(); }
  nn::TensorMap PolicyTensors() const override { return Finished().PolicyTensors(); }
  // An engine of the CPU has computed an update when Submit returns.
  nn::PendingTensors CopyPolicyTensors() const override { return agents_[0]->CopyPolicyTensors(); }
  nn::TensorMap AveragedPolicyTensors() const override {
    return Finished().AveragedPolicyTensors();
  }
  nn::TensorMap AllTensors() const override { return Finished().AllTensors(); }
  // The first replica refuses bad tensors before any replica changes.
  void Restore(const nn::TensorMap& tensors, const std::string& source) override {
    Finished();
    for (const auto& agent : agents_) agent->Restore(tensors, source);
  }

 private:
  // Calls `call` for each replica, by the replica's thread, and returns the outcomes that it
  // returns, which are the same for all replicas.
  using Call = std::function<std::vector<UpdateOutcome>(Agent& agent, int rank)>;
  std::vector<UpdateOutcome> OnEach(const Call& call) {
    std::vector<std::vector<UpdateOutcome>> outcomes(agents_.size());
    team_.Run([&](int rank) { outcomes[size_t(rank)] = call(*agents_[size_t(rank)], rank); });
    for (const std::vector<UpdateOutcome>& known : outcomes) {
      CHECK(std::ranges::equal(known, outcomes[0], {}, &UpdateOutcome::finite,
                               &UpdateOutcome::finite))
          << "replicas disagree";
    }
    for (const UpdateOutcome& outcome : outcomes[0]) {
      in_flight_ = outcome.finite ? in_flight_ - 1 : 0;
    }
    return std::move(outcomes[0]);
  }
  // The first replica, if no update is in flight.
  const Agent& Finished() const {
    CHECK(in_flight_ == 0) << in_flight_ << " updates are in flight";
    return *agents_[0];
  }
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
  int in_flight_ = 0;  // updates without an outcome
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
