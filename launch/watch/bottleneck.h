// Where the time of a run goes, and what to do about it: per process the share of each stage, who
// was held back by the limiter, and one sentence of advice. Pure.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "launch/watch/metrics_view.h"

namespace shoal::launch {

struct StageShare {
  std::string stage;  // "physics"; "other": in none of the named stages
  double share = 0;   // of the process's time, 0..1
};

struct ProcessTimes {
  std::string role;  // all processes of the role together
  int processes = 0;
  double seconds = 0;                // they ran, summed over processes
  double cores = 0;                  // processors used on average over the run, all together
  std::vector<StageShare> stages{};  // largest first
};

struct Bottleneck {
  double inserts_blocked = 0;  // share of time in which the limiter held actors back
  double samples_blocked = 0;  // ... the learner
  bool limited = true;         // there is a limiter: the run has a replay
  std::vector<ProcessTimes> roles;
  double cores = 0;    // processors used by all processes
  double usable = 0;   // processors there are
  std::string advice;  // one sentence
};

// What the run did so far, its restarted processes included; empty roles where nothing was
// reported. `usable_cores`: of this machine. `actors`: asked for now.
Bottleneck FindBottleneck(const MetricsView& view, double usable_cores, int actors);

// The sentence, from the other figures.
std::string Advise(const Bottleneck& figures, int actors);

// The report, a line per role and the advice.
std::vector<std::string> FormatBottleneck(const Bottleneck& bottleneck);
// bottleneck.json of a run (shoal-bottleneck-1). Throws Error.
void WriteBottleneck(const std::filesystem::path& run, const Bottleneck& bottleneck);

}  // namespace shoal::launch
