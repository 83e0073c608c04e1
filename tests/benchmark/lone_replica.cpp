// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/lone_replica.h"

#include "common/base/check.h"
#include "common/nn/parallel.h"
#include "common/nn/precision.h"
#include "common/nn/team.h"
#include "learner/agent/sac/sac_agent.h"

namespace shoal::bench {
namespace {

Config With(const std::string& encoder, int batch) {
  Config config;
  config.network.encoder = encoder;
  config.learner.batch = batch;
  config.learner.learning_rate = 1e-12;  // by gradients that are not updated: stays finite
  return config;
}

}  // namespace

LoneReplica::LoneReplica(const std::string& encoder, int batch, int replicas)
    : config_(With(encoder, batch)), noise_(config_, PixelSpec()), exchange_(replicas, batch) {
  const nn::Precision precision = nn::ChoosePrecision("auto", /*pixels=*/true);
  for (int rank = 0; rank < replicas; ++rank) {
    replicas_.emplace_back(&exchange_, rank);
    const nn::ThreadScope scope(1);
    engines_.emplace_back(precision, batch, &replicas_.back());
    agents_.push_back(learner::MakeSacAgent(config_, PixelSpec(), &engines_.back()));
  }
  for (int i = 0; i < 2; ++i) {  // what happens once
    nn::Team(replicas).Run([&](int rank) { agents_[size_t(rank)]->Update(noise_.batch); });
  }
  exchange_.SetMeets(false);
}

void LoneReplica::Update(int rank, const learner::OnStageEnd& on_stage_end) {
  CHECK(agents_[size_t(rank)]->Update(noise_.batch, on_stage_end).finite);
}

}  // namespace shoal::bench
