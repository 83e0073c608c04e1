// SPDX-License-Identifier: Apache-2.0
// Use of a run's time: the share of each stage for each role, the side that the limiter held back,
// and one sentence of advice. Pure.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "launch/watch/run_totals.h"

namespace shoal::launch {

// Time outside of the named stages.
inline constexpr std::string_view kOtherStage = "other";

struct StageShare {
  std::string stage;  // "physics", kOtherStage
  double share = 0;   // of the process's time, 0..1
};

struct ProcessTimes {
  std::string role;  // the times are those of all processes of the role together
  int processes = 0;
  double seconds = 0;                // run time, summed over processes
  double cores = 0;                  // processors used on average, summed over processes
  std::vector<StageShare> stages{};  // largest first
};

struct Bottleneck {
  double seconds = 0;          // length of the measured interval
  double inserts_blocked = 0;  // share of time in which the limiter held actors back
  double samples_blocked = 0;  // share of time in which the limiter held the learner back
  bool limited = true;         // the run has a replay, and therefore a limiter
  std::vector<ProcessTimes> roles{};
  double cores = 0;      // processors used by all processes
  double usable = 0;     // processors available
  std::string advice{};  // one sentence; empty if it is too early (advice.h)
};

// Resources that a run may use.
struct RunResources {
  double usable_cores = 0;        // of the coordinator's host
  int actors = 0;                 // requested number
  bool actors_elsewhere = false;  // there are actors on other hosts: the number cannot change
  int learner_threads = 0;        // 0: unknown
  int most_threads = 0;           // largest useful number (best_split.h); 0: unknown
  bool may_play_ahead = false;    // on policy with ppo.versions_ahead = 0
};

// Computes the shares from the totals. A role without counts has no stages.
Bottleneck FindBottleneck(const RunTotals& totals, const RunResources& resources);

// Name of a stage in words: "waiting credit".
std::string WordsOf(std::string stage);

// The share of a role's time in a stage; 0 if the role has no such stage.
double ShareOf(const Bottleneck& figures, std::string_view role, std::string_view stage);

// The report as text: one line for each role, then the advice.
std::vector<std::string> FormatBottleneck(const Bottleneck& bottleneck);
// Writes bottleneck.json of a run (shoal-bottleneck-1). Throws Error.
void WriteBottleneck(const std::filesystem::path& run, const Bottleneck& bottleneck);

}  // namespace shoal::launch
