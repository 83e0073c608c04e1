// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/scaling_parts.h"

#include <time.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/base/clock.h"
#include "common/nn/parallel.h"
#include "common/nn/precision.h"
#include "common/nn/team.h"
#include "learner/agent/algorithms.h"
#include "tests/benchmark/lone_replica.h"
#include "tests/benchmark/noise_batch.h"
#include "tests/benchmark/paired_timing.h"
#include "tests/common/nn/primitive_trace.h"

namespace shoal::bench {
namespace {

using nlohmann::ordered_json;

// CPU time of this thread: other work on the machine does not count.
double CpuMicroseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e6 * double(time.tv_sec) + 1e-3 * double(time.tv_nsec);
}

struct Samples {
  std::vector<double> update, primitives;  // us
  std::vector<double> stages[std::size(kStageNames)];
};

void MeasureRank(LoneReplica* lone, int rank, Samples* samples) {
  const double start = CpuMicroseconds();
  double last = start;
  double stages[std::size(kStageNames)] = {};
  for (const auto& order : kStageOrders) {
    size_t at = 0;
    lone->Update(rank, [&](learner::UpdateStage) {
      const double now = CpuMicroseconds();
      stages[order[at++]] += now - last;
      last = now;
    });
  }
  samples->update.push_back((last - start) / 2);
  for (size_t s = 0; s < std::size(kStageNames); ++s) samples->stages[s].push_back(stages[s] / 2);
}

}  // namespace

std::vector<ordered_json> ReplicaParts(const std::string& network, int batch,
                                       const std::vector<int>& replicas, int repetitions) {
  struct Case {
    std::unique_ptr<LoneReplica> lone;
    std::unique_ptr<nn::PrimitiveTrace> trace;
    std::vector<Samples> ranks;
  };
  std::vector<Case> cases;
  for (const int count : replicas) {
    Case& one = cases.emplace_back();
    one.lone = std::make_unique<LoneReplica>(network, batch, count);
    LoneReplica* lone = one.lone.get();
    one.trace = std::make_unique<nn::PrimitiveTrace>([lone] {
      for (int i = 0; i < 2; ++i) lone->Update(0);
    });
    one.ranks.resize(size_t(count));
  }
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (Case& one : cases) {
      for (size_t rank = 0; rank < one.ranks.size(); ++rank) {
        MeasureRank(one.lone.get(), int(rank), &one.ranks[rank]);
      }
      const double start = CpuMicroseconds();
      one.trace->Run();
      one.ranks[0].primitives.push_back((CpuMicroseconds() - start) / 2);
    }
  }
  std::vector<ordered_json> rows;
  for (const Case& one : cases) {
    double mean = 0, most = 0;
    ordered_json ranks = ordered_json::array();
    for (const Samples& rank : one.ranks) {
      const double update = Median(rank.update);
      mean += update / double(one.ranks.size());
      most = std::max(most, update);
      ranks.push_back(int(update));
    }
    ordered_json stages;
    for (size_t s = 0; s < std::size(kStageNames); ++s) {
      stages[kStageNames[s]] = Median(one.ranks.back().stages[s]);
    }
    rows.push_back({{"part", "an update of one replica alone, us of CPU"},
                    {"network", network},
                    {"batch", batch},
                    {"replicas", one.lone->replicas()},
                    {"mean_us", mean},
                    {"slowest_us", most},
                    {"ranks_us", ranks},
                    {"primitives_us", Median(one.ranks[0].primitives)},
                    {"primitives", one.trace->Count() / 2},
                    {"stages_of_last_us", stages}});
  }
  return rows;
}

double MeetingMicroseconds(int threads) {
  constexpr int kMeetings = 2'000;
  nn::Barrier barrier(threads, /*patient=*/true);
  nn::Team team(threads);
  double us = 0;
  team.Run([&](int rank) {
    for (int i = 0; i < 100; ++i) barrier.ArriveAndWait();
    const SteadyTime start = Now();
    for (int i = 0; i < kMeetings; ++i) barrier.ArriveAndWait();
    if (rank == 0) us = 1e6 * SecondsSince(start) / kMeetings;
  });
  return us;
}

double IndependentShare(const std::string& network, int batch, int threads, double seconds) {
  Config config;
  config.network.encoder = network;
  config.learner.batch = batch;
  const NoiseBatch noise(config, PixelSpec());
  auto agents = std::vector<std::unique_ptr<learner::Agent>>(size_t(threads));
  const nn::Precision precision = nn::ChoosePrecision("auto", /*pixels=*/true);
  nn::SetThreads(1);
  std::vector<double> rates(agents.size());
  const auto rate_of = [&](size_t i) {
    const SteadyTime start = Now();
    int updates = 0;
    for (; SecondsSince(start) < seconds; updates += 2) {
      for (int k = 0; k < 2; ++k) agents[i]->Update(noise.batch);
    }
    return updates / SecondsSince(start);
  };
  nn::Team team(threads);
  team.Run([&](int rank) {
    agents[size_t(rank)] = learner::MakeAgent(config, PixelSpec(), precision);
    for (int k = 0; k < 4; ++k) agents[size_t(rank)]->Update(noise.batch);
  });
  std::vector<double> shares;
  double before = rate_of(0);
  for (int repetition = 0; repetition < 5; ++repetition) {
    team.Run([&](int rank) { rates[size_t(rank)] = rate_of(size_t(rank)); });
    const double after = rate_of(0);
    double sum = 0;
    for (const double rate : rates) sum += rate;
    shares.push_back(sum / threads / ((before + after) / 2));
    before = after;
  }
  return Median(shares);
}

}  // namespace shoal::bench
