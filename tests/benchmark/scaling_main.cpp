// SPDX-License-Identifier: Apache-2.0
// shoal-bench-scaling: speed of N learner threads and cost of the parts of an update, as a JSON
// line for each network, batch and N (docs/performance_tables.md, "Threads of the learner").
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/base/clock.h"
#include "common/base/command_line.h"
#include "common/base/main_guard.h"
#include "common/base/stop.h"
#include "common/base/usable_cores.h"
#include "common/nn/parallel.h"
#include "common/nn/precision.h"
#include "learner/agent/algorithms.h"
#include "learner/openmp_environment.h"
#include "tests/benchmark/noise_batch.h"
#include "tests/benchmark/paired_timing.h"
#include "tests/benchmark/scaling_parts.h"

namespace shoal::bench {
namespace {

using nlohmann::ordered_json;

struct Options {
  std::vector<int> threads{1, 2}, batches{128};
  std::vector<std::string> networks{"compact"};
  double seconds = 1;
  int repetitions = 1, pairs = 0;
  std::string name = "ours";
};

void Print(const ordered_json& row) { std::cout << row.dump() << std::endl; }

double CpuSeconds(const rusage& usage) {
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Measured {
  double rate = 0, cpu = 0, switches = 0, waits = 0;
  ordered_json stages;  // us of an update by the first thread's clock
};

Measured Measure(learner::Agent* agent, const BatchView& batch, double seconds) {
  for (int i = 0; i < 4; ++i) agent->Update(batch);
  rusage before, after;
  getrusage(RUSAGE_SELF, &before);
  const SteadyTime start = Now();
  int updates = 0;
  double stages[std::size(kStageNames)] = {};
  do {
    for (int i = 0; i < 2; ++i, ++updates) {  // one of two moves the actor
      SteadyTime last = Now();
      size_t at = 0;
      agent->Update(batch, [&](learner::UpdateStage) {
        const SteadyTime now = Now();
        stages[kStageOrders[i][at++]] += 1e6 * std::chrono::duration<double>(now - last).count();
        last = now;
      });
    }
  } while (SecondsSince(start) < seconds);
  const double wall = SecondsSince(start);
  getrusage(RUSAGE_SELF, &after);
  ordered_json shown;
  for (size_t s = 0; s < std::size(kStageNames); ++s) shown[kStageNames[s]] = stages[s] / updates;
  return {updates / wall, (CpuSeconds(after) - CpuSeconds(before)) / updates,
          double(after.ru_nivcsw - before.ru_nivcsw) / updates,
          double(after.ru_nvcsw - before.ru_nvcsw) / updates, shown};
}

// The rates of two agents in turn, so that a machine whose speed drifts favours neither.
struct Paired {
  std::vector<double> one, several, ratios;
};

Paired MeasurePair(learner::Agent* one, learner::Agent* several, const BatchView& batch,
                   double seconds, int repetitions) {
  const auto rate = [&](learner::Agent* agent) {
    const SteadyTime start = Now();
    int updates = 0;
    do {
      for (int i = 0; i < 2; ++i, ++updates) agent->Update(batch);
    } while (SecondsSince(start) < seconds);
    return updates / SecondsSince(start);
  };
  for (int i = 0; i < 4; ++i) {
    one->Update(batch);
    several->Update(batch);
  }
  Paired paired;
  double before = rate(one);
  for (int i = 0; i < repetitions; ++i) {
    paired.several.push_back(rate(several));
    const double after = rate(one);
    paired.one.push_back((before + after) / 2);
    paired.ratios.push_back(paired.several.back() / paired.one.back());
    before = after;
  }
  return paired;
}

// A network and a batch of the default configuration.
struct Case {
  Case(const std::string& network, int batch) {
    config.network.encoder = network;
    config.learner.batch = batch;
  }
  std::unique_ptr<learner::Agent> AgentOf(int threads) const {
    nn::SetThreads(threads);
    return learner::MakeAgent(config, spec, nn::ChoosePrecision("auto", /*pixels=*/true));
  }

  Config config;
  const ObservationSpec spec = PixelSpec();
};

ordered_json RateRow(const Case& one, int threads, const Options& options) {
  const NoiseBatch noise(one.config, one.spec);
  const auto agent = one.AgentOf(threads);
  const Measured got = Measure(agent.get(), noise.batch, options.seconds);
  return {{"updates_per_second", got.rate},
          {"cpu_ms_per_update", 1e3 * got.cpu},
          {"involuntary_switches", got.switches},
          {"sleeps", got.waits},
          {"stages_us", got.stages}};
}

ordered_json PairRow(const Case& one, int threads, const Options& options) {
  const NoiseBatch noise(one.config, one.spec);
  const auto several = one.AgentOf(threads), single = one.AgentOf(1);
  const Paired paired =
      MeasurePair(single.get(), several.get(), noise.batch, options.seconds, options.pairs);
  const auto [least, most] = std::minmax_element(paired.ratios.begin(), paired.ratios.end());
  return {{"paired_rate", Median(paired.several)},
          {"paired_rate_of_one", Median(paired.one)},
          {"efficiency", Median(paired.ratios) / threads},
          {"least", *least / threads},
          {"most", *most / threads}};
}

void PrintRates(const Options& options) {
  for (const std::string& network : options.networks) {
    for (const int batch : options.batches) {
      const Case one(network, batch);
      for (const int threads : options.threads) {
        ordered_json row{
            {"side", options.name}, {"network", network}, {"batch", batch}, {"threads", threads}};
        row.update(options.pairs > 0 ? PairRow(one, threads, options)
                                     : RateRow(one, threads, options));
        Print(row);
      }
    }
  }
}

void PrintParts(const Options& options) {
  for (const int threads : options.threads) {
    if (threads > UsableCores()) continue;
    Print({{"part", "a meeting, us"}, {"threads", threads}, {"us", MeetingMicroseconds(threads)}});
  }
  for (const std::string& network : options.networks) {
    for (const int batch : options.batches) {
      for (const ordered_json& row :
           ReplicaParts(network, batch, options.threads, options.repetitions)) {
        Print(row);
      }
    }
  }
}

void PrintIndependent(const Options& options) {
  for (const std::string& network : options.networks) {
    for (const int batch : options.batches) {
      for (const int threads : options.threads) {
        const int rows = std::max(1, batch / threads);
        Print({{"part", "share of a core that each of N threads has if they share nothing"},
               {"network", network},
               {"rows", rows},
               {"threads", threads},
               {"share", IndependentShare(network, rows, threads, options.seconds)}});
      }
    }
  }
}

int Run(int argc, char** argv) {
  Options options;
  bool parts = false, independent = false;
  CLI::App app("Updates of N learner threads, and what their parts cost, as JSON lines.",
               "shoal-bench-scaling");
  AddVersion(&app);
  app.add_option("--threads", options.threads, "numbers of threads")->delimiter(',');
  app.add_option("--batches", options.batches, "sizes of the batch")->delimiter(',');
  app.add_option("--networks", options.networks, "values of network.encoder")->delimiter(',');
  app.add_option("--seconds", options.seconds, "of each measurement");
  app.add_option("--repetitions", options.repetitions, "of --parts");
  app.add_option("--pairs", options.pairs, "measure one thread and N in turn, so many times");
  app.add_option("--name", options.name, "of the rows");
  app.add_flag("--parts", parts, "what the parts of an update cost");
  app.add_flag("--independent", independent, "threads that share nothing");
  if (const auto exit_code = ParseCommandLine(&app, argc, argv)) return *exit_code;
  learner::EnsurePassiveOpenMp(1, argv);
  InstallStopSignals();
  if (parts) {
    PrintParts(options);
  } else if (independent) {
    PrintIndependent(options);
  } else {
    PrintRates(options);
  }
  return 0;
}

}  // namespace
}  // namespace shoal::bench

int main(int argc, char** argv) {
  return shoal::GuardMain("shoal-bench-scaling", [&] { return shoal::bench::Run(argc, argv); });
}
