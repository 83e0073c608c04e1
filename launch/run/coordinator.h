// SPDX-License-Identifier: Apache-2.0
// Runs a run: starts its processes, keeps them alive, hears them, shows what they do, decides when
// to stop, stops them in order.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "common/config/run_config.h"
#include "common/link/hub.h"
#include "launch/processes/remote_host.h"
#include "launch/record/run_meta.h"
#include "launch/run/operator_desk.h"
#include "launch/watch/bottleneck.h"
#include "launch/watch/progress.h"

namespace shoal::launch {

struct RunResult {
  RunMeta meta;
  bool clean = true;                // every process left by itself with code 0, or kUnwrittenExit
  std::string deaths;               // Supervisor::DescribeDeaths
  std::set<std::string> unwritten;  // files, or processes, that could not write what they have
  Bottleneck bottleneck;
};

class Coordinator {
 public:
  // `run` holds config.json and cluster.json. `meta` is a fresh one, or the resumed run's. `hosts`
  // have the run (run_hosts.h). Borrows the coordinator's hub, `desk` and `progress`. Throws Error.
  Coordinator(const std::filesystem::path& run, const RunConfig& config, link::Hub& hub,
              const RunMeta& meta, const std::vector<RemoteHost>& hosts, OperatorDesk& desk,
              Progress& progress);
  ~Coordinator();

  // Until the target, the budget, Ctrl-C, `shoal stop` or a failure; no process is left when it
  // returns. Call on the thread that lives longest (child_process.h). Throws Error when a process
  // cannot be started. `on_started` is called once, when every process has reported for the first
  // time; may be null.
  RunResult Run(const std::function<void()>& on_started);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::launch
