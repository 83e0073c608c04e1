// SPDX-License-Identifier: Apache-2.0
// The coordinator of a run: starts the run's processes, restarts dead processes, receives messages,
// writes the run's files, shows the run's progress and stops the processes in order. The decisions
// are in run_decisions.h.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/config/config.h"
#include "common/link/hub.h"
#include "common/link/run_topology.h"
#include "launch/processes/remote_host.h"
#include "launch/processes/running_process.h"
#include "launch/processes/supervisor.h"
#include "launch/record/energy_meter.h"
#include "launch/record/run_meta.h"
#include "launch/run/command_handler.h"
#include "launch/run/control_sender.h"
#include "launch/run/core_split.h"
#include "launch/run/evaluation_intake.h"
#include "launch/run/live_settings.h"
#include "launch/run/run_decisions.h"
#include "launch/run/run_inbox.h"
#include "launch/run/run_record.h"
#include "launch/run/run_server.h"
#include "launch/run/run_watch.h"
#include "launch/watch/bottleneck.h"
#include "launch/watch/progress.h"

namespace shoal::launch {

struct RunResult {
  RunMeta meta;
  bool clean = true;                // every process exited by itself with code 0 or kUnwrittenExit
  std::string deaths;               // Supervisor::DescribeDeaths
  std::set<std::string> unwritten;  // files or processes with unwritten results
  Bottleneck bottleneck;
};

class Coordinator {
 public:
  struct Parts {
    std::filesystem::path run;      // the run's folder, with config.json and cluster.json
    const Config& config;           // content of config.json
    const RunMeta& before;          // meta.json of the resumed run; initial values for a fresh run
    std::vector<RemoteHost> hosts;  // other hosts, which have a copy of the run (run_hosts.h)
    link::Hub& hub;                 // of the role coordinator
    RunServer& server;
    Progress& progress;
    ProcessStarter start = StartChild;  // starts a process of the run
    // Limits within which the run divides the cores by its measurements; empty: the numbers of
    // actors and learner threads stay.
    std::optional<SplitLimits> split_limits = {};
  };

  // Borrows hub, server and progress. Throws Error.
  explicit Coordinator(const Parts& parts);

  // Runs until the target, the budget, Ctrl-C, `shoal stop` or a failure. When the call returns, no
  // process runs any more. Call on the thread that lives longest (child_process.h). Throws Error if
  // a process cannot be started. `on_started` is called once, when every process has reported for
  // the first time; may be null.
  RunResult Run(const std::function<void()>& on_started);

 private:
  CommandHandler::Effects Effects();

  // The stages of a run.
  RunEnd WaitForEnd(const std::function<void()>& on_started);
  void Stop(RunEnd end);
  RunResult Result();

  // One turn of the loop: heartbeat, messages, files, display. An Error in a turn fails the run.
  void Tick(bool last = false);
  void SaySuspensions();
  void TakeMessages(SteadyTime now);
  void TakeEvaluation(const EvalMessage& message);
  void TakeCommands();
  // Once a second: changes the numbers of actors and learner threads if the run gets faster.
  void DivideCores();
  void Divide(const Split& to);
  void WriteFiles(SteadyTime now);
  void WriteMeta(SteadyTime now);
  void Show(bool last, SteadyTime now);

  // Effects of commands.
  void Scale(int from, int to);
  void Note(SettingChange change);

  void Say(const std::optional<std::string>& line);

  // Seconds of the run without pauses, with earlier sessions.
  double Elapsed() const;
  RunResources Resources() const;
  ProgressFigures Figures(SteadyTime now) const;
  // Number of the whole run's episodes that ended because of a number that is not finite, by cause.
  std::map<std::string, uint64_t> FaultyEpisodes() const;
  // Adds the cost of this session to that of the earlier sessions in `meta`.
  void AddCost(RunMeta* meta) const;
  // The present content for meta.json.
  RunMeta Meta() const;

  const std::filesystem::path run_;
  const Config config_;  // at the start of the run
  const std::vector<RemoteHost> hosts_;
  RunServer& server_;
  Progress& progress_;
  RunMeta before_;  // values of the earlier sessions, and the changes of this session
  LiveSettings settings_;
  const link::RunTopology topology_;  // at the start; `shoal scale` may change the actors
  CommandHandler handler_;
  RunDecisions decisions_;
  std::optional<CoreSplit> split_;  // empty: the user chose the numbers
  EvaluationIntake evaluations_;
  RunRecord record_;
  RunWatch watch_;
  Supervisor supervisor_;
  ControlSender control_;
  RunInbox inbox_;

  const SteadyTime start_;  // of the clock AwakeNow()
  EnergyMeter energy_;
  const int usable_cores_;
  std::optional<SteadyTime> meta_written_;
  bool meta_due_ = false;  // an event for meta.json has happened
  int suspensions_said_, refusals_said_;
};

}  // namespace shoal::launch
