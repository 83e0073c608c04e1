// SPDX-License-Identifier: Apache-2.0
// Keeps a run's processes alive: starts them, restarts what dies within limits, says why it died.
// A process that is there but says nothing any more - stopped, deadlocked, thrashing - is killed
// and counts as dead from then on.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/silence.h"
#include "launch/processes/child_process.h"
#include "launch/processes/restart_policy.h"

namespace shoal::launch {

// Silence after which a running process is taken for hung. Ten times what a process stopped for a
// moment or starved by its machine needs to be heard again; starting up takes longer.
struct HangLimits {
  std::chrono::seconds start{120};  // before its first report
  std::chrono::seconds report{30};  // since its last one
};

// Knows nothing of DDS. One thread, which must live as long as the children (child_process.h).
// Destruction kills what still runs.
class Supervisor {
 public:
  // `say` gets one line for each death and restart, with the process's last words (last_words.h).
  Supervisor(const RestartLimits& limits, const HangLimits& hang_limits,
             std::function<void(const std::string&)> say);

  // Starts the process; where its predecessor was retired and has not left yet, once that has.
  // Throws Error when it cannot be started.
  void Start(const ProcessSpec& spec);
  // Ends one process for good: SIGTERM, and SIGKILL when it has not left after kRetire.
  void Retire(std::string_view role, int id, SteadyTime now);

  // The process has reported. Words of a predecessor (another pid) do not count;
  // elsewhere our child is the remote shell, whose pid nobody reports.
  void Heard(std::string_view role, int id, pid_t pid, SteadyTime now);

  // Kills the hung, reaps the dead and starts what is due again. When the run cannot go on - a
  // process died too often, refused its configuration (exit 2) or met a non-finite number (exit 3)
  // - one line saying which and why.
  std::optional<std::string> Poll(SteadyTime now);

  // From now on processes of the role ("" = all) may exit and are not restarted.
  void ExpectExit(std::string_view role);
  void Signal(std::string_view role, int signal);
  // Processes of the role ("" = all) that run or wait for their restart.
  int Running(std::string_view role) const;

  // The running process's; 0 when there is none.
  pid_t Pid(std::string_view role, int id) const;

  int restarts() const { return restarts_; }

  // What a retired actor needs to flush what it has, and more.
  static constexpr std::chrono::seconds kRetire{40};

  // Expected exits that were not clean, each as one line. Death by a stop signal that was sent with
  // Signal or Retire is clean.
  const std::vector<std::string>& unclean_exits() const { return unclean_exits_; }

 private:
  struct Child {
    ProcessSpec spec;
    RestartPolicy policy;
    RestartPolicy connection;  // for lost connections to a process elsewhere
    std::optional<ChildProcess> process;
    uintmax_t output_before = 0;  // bytes in its output when `process` was started
    Silence silence;              // of `process`
    bool heard = false;
    bool hung = false;  // and killed for it
    std::optional<SteadyTime> restart_at;
    bool exit_expected = false;
    std::optional<SteadyTime> leave_by;    // retired: SIGKILL then
    std::optional<ProcessSpec> successor;  // to be started once it has left
    int signalled = 0;                     // the last signal sent by Signal or Retire
  };

  void Launch(Child& child, SteadyTime now);
  void KillIfHung(Child& child, SteadyTime now);
  void KillIfOverdue(Child& child, SteadyTime now);
  std::optional<std::string> OnExit(Child& child, const ExitStatus& status, SteadyTime now);
  void OnExpectedExit(Child& child, const ExitStatus& status);

  const RestartLimits limits_;
  const HangLimits hang_limits_;
  std::function<void(const std::string&)> say_;
  std::vector<Child> children_;
  int restarts_ = 0;
  std::vector<std::string> unclean_exits_;
};

}  // namespace shoal::launch
