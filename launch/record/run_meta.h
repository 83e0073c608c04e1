// SPDX-License-Identifier: Apache-2.0
// The content of a run's meta.json (shoal-run-1): builds, inputs, progress, results and end of the
// run.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "launch/record/accounting.h"
#include "launch/record/evaluation_point.h"
#include "launch/record/run_inputs.h"
#include "launch/record/setting_change.h"

namespace shoal::launch {

struct RunMeta {
  std::vector<std::string> commits;  // earlier builds of the run, oldest first
  PolicyInputs policy_inputs;
  PrivilegedInputs privileged_inputs;
  std::string started, finished;  // UTC; finished is empty while running
  uint64_t env_steps = 0, updates = 0;
  uint64_t updates_lost = 0;  // lost with learners that died (common/run_folder/update_page.h)
  double wall_seconds = 0;    // over all sessions of a resumed run
  // Both are sums over all sessions; empty if a session did not count them. Processor time of
  // replay, learner, actors and evaluation, on all hosts; and energy of the coordinator's host with
  // other programs (energy_meter.h), in Wh.
  std::optional<double> cpu_seconds = 0, energy_wh = 0;
  double target = 0;  // success rate of first_success
  std::optional<EvaluationPoint> first_success;
  std::optional<EvaluationPoint> best;  // best evaluation during training
  std::optional<double> final_success;  // success rate of the final evaluation
  std::optional<double> final_return;   // mean return of the final evaluation
  std::optional<Accounting> accounting;
  std::vector<SettingChange> changes;  // changes of keys during the run
  int restarts = 0;
  uint64_t resends = 0;  // records that actors sent again
  // Number of the training actors' episodes that ended because of a number that is not finite, by
  // cause (actor/worlds/episode_fault.h).
  std::map<std::string, uint64_t> faulty_episodes;
  std::string exit = "running";  // at the end "target", "budget", "interrupted" or "failed"
  std::string error;             // reason of a failure
};

// Writes meta.json; the learner's processor is that of learner_device.json. The member
// `updates_per_env_step` is the ratio so far, null before the first env step. Throws Error.
void WriteRunMeta(const std::filesystem::path& run, const Config& config, const RunMeta& meta);

// "while training: success >= 98 % over 2 evaluations in a row, first from 60012 env steps, 5400
// updates, 98 s on", plus a remark if the final evaluation, which plays other episodes, is below
// the target. If the target was never reached, the text says so. Empty without success or
// evaluations.
std::string FormatFirstSuccess(const RunMeta& meta, int evaluations);

// Reads the members that a resumed run continues: commits, started, wall_seconds, the counters, the
// changes, the run's end and the result of its final evaluation. If the file is missing, returns
// the initial values. Throws Error if the file is broken.
RunMeta ReadRunMeta(const std::filesystem::path& run);

}  // namespace shoal::launch
