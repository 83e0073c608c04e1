// SPDX-License-Identifier: Apache-2.0
// Use of a run's time: per role the share of each stage, the side that the limiter held back, and
// one sentence of advice. Pure.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "launch/watch/run_totals.h"

namespace shoal::launch {

// In none of the named stages.
inline constexpr std::string_view kOtherStage = "other";

struct StageShare {
  std::string stage;  // "physics", kOtherStage
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
  double seconds = 0;          // the run's time that was looked at
  double inserts_blocked = 0;  // share of time in which the limiter held actors back
  double samples_blocked = 0;  // ... the learner
  bool limited = true;         // there is a limiter: the run has a replay
  std::vector<ProcessTimes> roles{};
  double cores = 0;      // processors used by all processes
  double usable = 0;     // processors there are
  std::string advice{};  // one sentence; empty: too early for one (advice.h)
};

// Resources that a run may use.
struct RunResources {
  double usable_cores = 0;        // of the coordinator's host
  int actors = 0;                 // asked for
  bool actors_elsewhere = false;  // on other hosts: it has those that were named at its start
  int learner_threads = 0;        // 0: not known
  int most_threads = 0;           // that have rows of a batch; 0: not known
  bool may_play_ahead = false;    // on policy with ppo.versions_ahead = 0
};

// Computes the shares from the totals; roles without counts are empty.
Bottleneck FindBottleneck(const RunTotals& totals, const RunResources& resources);

// A stage's name as words: "waiting credit".
std::string WordsOf(std::string stage);

// The share of its time that a role spent in a stage; 0 where it has none.
double ShareOf(const Bottleneck& figures, std::string_view role, std::string_view stage);

// The report, a line per role and the advice.
std::vector<std::string> FormatBottleneck(const Bottleneck& bottleneck);
// bottleneck.json of a run (shoal-bottleneck-1). Throws Error.
void WriteBottleneck(const std::filesystem::path& run, const Bottleneck& bottleneck);

}  // namespace shoal::launch
