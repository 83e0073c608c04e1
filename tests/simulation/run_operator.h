// SPDX-License-Identifier: Apache-2.0
// Simulates the user of a run: starts the run, resumes it after the coordinator was killed or the
// run ended early, follows the advice of error messages, and triggers faults and commands.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "launch/record/run_meta.h"
#include "tests/simulation/fault.h"
#include "tests/simulation/simulated_clients.h"
#include "tests/simulation/simulated_disk.h"
#include "tests/simulation/train_session.h"

namespace shoal::simulation {

class RunOperator {
 public:
  // Borrows the arguments.
  RunOperator(const World& world, FiberScheduler& scheduler, SimulatedDisk& disk)
      : world_(world), scheduler_(scheduler), disk_(disk), clients_(world) {}

  // Starts and resumes the run until it has reached its end. Runs in a simulated thread.
  void Work();
  // Triggers each fault at its time. Runs in a simulated thread of a separate group.
  void Strike(const std::vector<Fault>& faults);

  // True if the run has reached its end.
  bool finished() const { return finished_; }
  // Whether all processes ended cleanly in the last session.
  bool last_clean() const { return last_clean_; }
  int sessions() const { return sessions_; }
  // End of the last fault, including its span.
  SteadyTime quiet_from() const { return quiet_from_; }

 private:
  void RunSession(Begin begin);
  void JudgeExit(const SimulatedProcess& coordinator);
  // Whether the session has printed `text`.
  bool Said(std::string_view text) const;
  // Whether the session's output names a failed process or a file.
  bool SaidWhoFailed() const;
  // Reads meta.json and checks that env steps do not decrease.
  launch::RunMeta TakeMeta();
  // Prepares the next session. Returns how the session begins.
  Begin Prepare();
  Begin NextBegin(Begin wanted);
  void WaitForChildren();
  void Do(const Fault& fault);
  void Pause(const Fault& fault, SimulatedProcess& process);
  void KillCoordinator(const Fault& fault, SimulatedProcess& coordinator);
  void AskAsSecond();
  void After(std::chrono::milliseconds span, std::function<void()> body);

  const World& world_;
  FiberScheduler& scheduler_;
  SimulatedDisk& disk_;
  SimulatedClients clients_;
  bool finished_ = false, last_clean_ = true;
  bool began_on_full_disk_ = false;  // the disk was full when the session began
  SteadyTime trouble_until_{};       // until this time, sessions may end (MayEndSessions)
  SteadyTime disk_full_until_{};     // end of the last full disk
  int sessions_ = 0, rivals_ = 0;
  ptrdiff_t session_begin_ = 0;    // index of the session's first line in the story
  const Fault* killed_ = nullptr;  // the fault that killed the last coordinator
  std::string last_words_;
  uint64_t env_steps_ = 0;  // at the end of the last session
  SteadyTime quiet_from_{};
};

}  // namespace shoal::simulation
