// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/acting_cost.h"

#include <ctime>

#include "common/base/clock.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/parameter_set.h"
#include "common/nn/safetensors.h"

namespace shoal::bench {

std::string FirstWeights(const RunConfig& run) {
  nn::ParameterSet parameters(nn::PolicyParameters(run.config.network, run.spec),
                              nn::ParameterSet::Use::kInference);
  parameters.Initialise(1);
  nn::TensorMap tensors;
  parameters.Export(&tensors);
  return nn::WriteSafetensors(tensors, {});
}

std::unique_ptr<actor::ActionSelector> MakeSelector(const RunConfig& run,
                                                    const std::string& weights) {
  auto selector =
      std::make_unique<actor::ActionSelector>(run.config, run.spec, run.config.envs_per_actor);
  selector->Load({{/*session=*/1, /*update=*/1}, 0, "", weights});
  for (int e = 0; e < run.config.envs_per_actor; ++e) {
    selector->BeginEpisode(e, static_cast<uint64_t>(e));
  }
  return selector;
}

namespace {

double CpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct InferCost {
  double wall = 0, cpu = 0;  // seconds of an action
};

InferCost MeasureInference(const RunConfig& run, const std::string& weights, double seconds) {
  const auto selector = MakeSelector(run, weights);
  selector->Select(actor::Acting::kExplore);
  const SteadyTime start = Now();
  const double cpu = CpuSeconds();
  int actions = 0;
  do {
    selector->Select(actor::Acting::kExplore);
    actions += run.config.envs_per_actor;
  } while (SecondsSince(start) < seconds);
  return {.wall = SecondsSince(start) / actions, .cpu = (CpuSeconds() - cpu) / actions};
}

}  // namespace

double InferSeconds(const RunConfig& run, const std::string& weights, double seconds) {
  return MeasureInference(run, weights, seconds).wall;
}

double InferCpuSeconds(const RunConfig& run, const std::string& weights, double seconds) {
  return MeasureInference(run, weights, seconds).cpu;
}

}  // namespace shoal::bench
