// SPDX-License-Identifier: Apache-2.0
// The options of `shoal train`, and the configuration that results from these options.
#pragma once

#include <string>
#include <vector>

#include "common/config/config.h"
#include "launch/run/environment_choice.h"

namespace shoal::launch {

struct TrainOptions {
  std::string preset, config_file;
  std::vector<std::string> set;     // KEY=VALUE
  std::string run_name;             // empty = automatic
  std::string run_dir;              // folder of the runs; empty = the value of the key run_dir
  std::string hosts;                // file of other hosts; empty = none, or the resumed run's hosts
  std::string secure;               // folder of credentials; empty = none, or the resumed run's
  std::string init_from, name_map;  // safetensors and JSON file (common/nn/named_weights.h)
  std::string resume;               // run to continue: its path or its name
  bool overwrite = false, lockstep = false;
  bool print_config = false, dry_run = false;
  bool film = false;        // film the judged checkpoint at the end
  bool in_process = false;  // all roles as threads of this process
  bool detach = false;      // return after the run has started in the background
  std::string prometheus;   // PORT or ADDRESS:PORT at which metrics are served; empty = none
};

// The configuration from `defaults`, preset, file, --set and the other options. A later source
// replaces the values of an earlier source. Throws Error (usage).
Config GivenConfig(const TrainOptions& options, const EnvironmentDefaults& defaults = {});
// The configuration of GivenConfig, with `actors` and `learner.threads` filled in for `cores`, and
// validated. Throws Error (usage).
Config ResolveConfig(const TrainOptions& options, int cores,
                     const EnvironmentDefaults& defaults = {});

// Applies the options to the configuration of a resumed run. The options may set env_steps, stop.*
// and, for another machine, learner.precision, replay.keep and learner.threads (0: filled in for
// `cores`). Throws Error (usage) for other keys or options.
void ApplyResumeOptions(const TrainOptions& options, int cores, Config* config);
// Whether KEY=VALUE is such a setting for another machine. A running run does not accept these
// settings.
bool SetsForMachine(const std::string& assignment);

}  // namespace shoal::launch
