// SPDX-License-Identifier: Apache-2.0
// Supervises a run's processes: starts the processes, restarts dead processes, and reports the
// reasons of deaths. A process that runs but no longer reports (stopped, deadlocked, thrashing) is
// killed and counts as dead.
//
// A process that the run needs is restarted within RestartLimits; the run fails if the process dies
// more often. An expendable process is restarted at growing intervals (RestartBackoff) for as long
// as the run lasts; the caller decides whether the run continues without the process
// (working_actors.h).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/liveness_timer.h"
#include "launch/processes/restart_backoff.h"
#include "launch/processes/restart_policy.h"
#include "launch/processes/running_process.h"

namespace shoal::launch {

// Liveness timeouts after which a running process counts as hung. A process that was stopped for a
// moment, or that got no CPU time, is silent for at most a tenth of `report`. A start takes longer.
struct HangLimits {
  std::chrono::seconds start{120};  // before its first report
  std::chrono::seconds report{30};  // since its last report
};

// An expendable process that has died and does not yet work again.
struct DownProcess {
  std::string name;    // "actor-1"
  std::string reason;  // of its last death: "exit code 1: no way to host ..."
  int deaths = 0;      // consecutive deaths
  std::optional<std::chrono::seconds> restart_in;  // empty during a restart
  // Reason why further restarts seem useless: the process died more often than RestartLimits allow,
  // or refused its configuration. Empty otherwise.
  std::string hopeless;
};

// The expendable processes of a role, without processes that are expected to exit.
struct RoleStanding {
  int processes = 0;
  int working = 0;                // processes that have reported for kSettled since the last start
  std::vector<DownProcess> down;  // a process in its first start is neither working nor down
};

// Independent of DDS. One thread, which must live as long as the children (child_process.h). The
// destructor kills processes that still run.
class Supervisor {
 public:
  // `say` gets one line for each death and restart, with the reason of the exit (exit_reason.h).
  // `start` starts a process.
  Supervisor(const RestartLimits& limits, const HangLimits& hang_limits,
             std::function<void(const std::string&)> say, ProcessStarter start = StartChild);

  // Starts the process. If a retired predecessor still runs, starts it after the predecessor's end.
  // Throws Error if the process cannot be started.
  void Start(const ProcessSpec& spec);
  // Ends one process without a restart: SIGTERM, and SIGKILL if it still runs after kRetire.
  void Retire(std::string_view role, int id, SteadyTime now);

  // Notes a report of the process. Reports of a predecessor (another pid) do not count. On other
  // hosts all reports count, because the child is the remote shell and the reported pid is unknown.
  void Heard(std::string_view role, int id, pid_t pid, SteadyTime now);

  // Kills hung processes, reaps dead processes and restarts processes whose delay is over. If the
  // run cannot continue, returns one line with the process and the reason: a process met a
  // non-finite number (exit 3), or a process that is not expendable died too often or refused its
  // configuration (exit 2).
  std::optional<std::string> Poll(SteadyTime now);

  // From now on processes of the role ("" = all) may exit and are not restarted.
  void ExpectExit(std::string_view role);
  void Signal(std::string_view role, int signal);
  // Number of processes of the role ("" = all) that run or wait for their restart.
  int Running(std::string_view role) const;

  // The role's expendable processes.
  RoleStanding Standing(std::string_view role, SteadyTime now) const;

  // Pid of the running process; 0 if none runs.
  pid_t Pid(std::string_view role, int id) const;

  int restarts() const { return restarts_; }

  // Unexpected deaths of expendable processes, sorted by number: "actor-1 12 times (last: exit code
  // 1: no way to host)". Empty if no such process died.
  std::string DescribeDeaths() const;

  // Longer than a retired actor needs to send its records.
  static constexpr std::chrono::seconds kRetire{40};

  // A restarted process counts as working after it has reported for this time.
  static constexpr std::chrono::seconds kSettled{10};

  // Processes that left as expected, but could not write all of their results (kUnwrittenExit).
  const std::set<std::string>& unwritten_exits() const { return unwritten_exits_; }
  // Other expected exits that were not clean, each as one line. An exit is also clean if the
  // process died of a signal that Signal or Retire sent.
  const std::vector<std::string>& unclean_exits() const { return unclean_exits_; }

 private:
  struct Child {
    ProcessSpec spec;
    RestartPolicy policy;
    RestartPolicy connection;  // for lost connections to a process elsewhere
    std::unique_ptr<RunningProcess> process;
    uintmax_t output_before = 0;            // bytes in the output file when `process` was started
    LivenessTimer liveness;                 // of `process`
    std::optional<SteadyTime> heard_since;  // first report of `process`
    bool hung = false;                      // stopped reporting and was killed
    std::optional<SteadyTime> restart_at;
    RestartBackoff backoff{BackoffLimits()};  // of an expendable process
    DownProcess down;                         // of an expendable process that has died
    int deaths = 0;                           // of an expendable process, over the whole run
    bool exit_expected = false;
    std::optional<SteadyTime> leave_by;    // time of SIGKILL, for a retired process
    std::optional<ProcessSpec> successor;  // process to start after the exit
    int signalled = 0;                     // the last signal sent by Signal or Retire
  };

  void Launch(Child& child, SteadyTime now);
  void KillIfHung(Child& child, SteadyTime now);
  void KillIfOverdue(Child& child, SteadyTime now);
  std::optional<std::string> OnExit(Child& child, const ExitStatus& status, SteadyTime now);
  // Plans the restart of an expendable process that died of `reason`.
  void BackOff(Child& child, const ExitStatus& status, const std::string& reason, SteadyTime now);
  void OnExpectedExit(Child& child, const ExitStatus& status);

  const RestartLimits limits_;
  const HangLimits hang_limits_;
  std::function<void(const std::string&)> say_;
  const ProcessStarter start_;
  std::vector<Child> children_;
  int restarts_ = 0;
  std::set<std::string> unwritten_exits_;
  std::vector<std::string> unclean_exits_;
};

}  // namespace shoal::launch
