// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/algorithms.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/config/learner_threads.h"
#include "common/nn/parallel.h"
#include "learner/agent/ddpg/ddpg_agent.h"
#include "learner/agent/drqv2/drqv2_agent.h"
#include "learner/agent/frame_figures.h"
#include "learner/agent/mrq/mrq_agent.h"
#include "learner/agent/ppo/ppo_agent.h"
#include "learner/agent/replicated_agent.h"
#include "learner/agent/sac/sac_agent.h"
#include "learner/agent/sample_figures.h"
#include "learner/agent/td3/td3_agent.h"

namespace shoal::learner {
namespace {

constexpr Algorithm kAlgorithms[] = {
    {.name = "sac",
     .figures = kSacFigures,
     .critics = 2,
     .critics_of = [](const Config& config) { return config.sac.critics; },
     .sb3 = "SAC",
     .make = MakeSacAgent},
    {.name = "td3", .figures = kTwinFigures, .critics = 2, .sb3 = "TD3", .make = MakeTd3Agent},
    {.name = "ddpg",
     .figures = kSingleCriticFigures,
     .critics = 1,
     .sb3 = "DDPG",
     .make = MakeDdpgAgent},
    {.name = "drqv2", .figures = kTwinFigures, .critics = 2, .sb3 = "TD3", .make = MakeDrqv2Agent},
    {.name = "mrq",
     .figures = kMrqFigures,
     .critics = 2,
     .make = MakeMrqAgent,
     .on_devices = false},
    {.name = "ppo",
     .figures = kPpoFigures,
     .sb3 = "PPO",
     .make = MakePpoAgent,
     .divides_rows = false},
};

std::vector<const Figure*> CollectFigures() {
  std::vector<const Figure*> all;
  const auto add = [&](std::span<const Figure* const> figures) {
    for (const Figure* figure : figures) {
      if (std::ranges::find(all, figure->name, &Figure::name) == all.end()) all.push_back(figure);
    }
  };
  for (const Algorithm& algorithm : kAlgorithms) add(algorithm.figures);
  add(kSampleFigures);
  add(kFrameFigures);
  return all;
}

}  // namespace

std::span<const Algorithm> Algorithms() { return kAlgorithms; }

const Algorithm& FindAlgorithm(std::string_view name) {
  const auto algorithm = std::ranges::find(kAlgorithms, name, &Algorithm::name);
  if (algorithm != std::end(kAlgorithms)) return *algorithm;
  std::vector<std::string_view> names;
  for (const Algorithm& known : kAlgorithms) names.push_back(known.name);
  throw UsageError("learner.algorithm = \"{}\": expected {}", name, fmt::join(names, " | "));
}

int CriticsOf(const Config& config) {
  const Algorithm& algorithm = FindAlgorithm(config.learner.algorithm);
  return algorithm.critics_of != nullptr ? algorithm.critics_of(config) : algorithm.critics;
}

int ReplicasOf(const Config& config, const ObservationSpec& spec, int threads) {
  if (threads == 1 || !FindAlgorithm(config.learner.algorithm).divides_rows) return 1;
  if (NormalisesOverBatch(config.network, spec)) return 1;
  CheckReplicas(config, threads);
  return threads;
}

std::string DescribeThreads(const Config& config, const ObservationSpec& spec, int threads,
                            int cores) {
  if (threads == 1) return "1 thread";
  const char* more = threads > cores ? ", more than there are cores" : "";
  if (ReplicasOf(config, spec, threads) > 1) {
    return fmt::format("{} threads, a replica each{}", threads, more);
  }
  const bool unknown = !FindAlgorithm(config.learner.algorithm).divides_rows;
  return fmt::format("{} threads that share each layer: {}{}", threads,
                     unknown ? config.learner.algorithm + " knows no replicas"
                             : config.network.encoder + " normalises over the batch",
                     more);
}

std::unique_ptr<Agent> MakeAgent(const Config& config, const ObservationSpec& spec,
                                 nn::Precision precision) {
  const Algorithm& algorithm = FindAlgorithm(config.learner.algorithm);
  const MakeReplica make = [&](Engine* engine) { return algorithm.make(config, spec, engine); };
  return MakeReplicatedAgent(config, precision, ReplicasOf(config, spec, nn::Threads()), make);
}

std::span<const Figure* const> AllFigures() {
  static const std::vector<const Figure*> all = CollectFigures();
  return all;
}

const Figure* FindFigure(std::string_view name) {
  const auto all = AllFigures();
  const auto at = std::ranges::find(all, name, &Figure::name);
  return at == all.end() ? nullptr : *at;
}

}  // namespace shoal::learner
