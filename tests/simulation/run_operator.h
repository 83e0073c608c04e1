// SPDX-License-Identifier: Apache-2.0
// The person at a simulated run: starts it, resumes it when its coordinator was killed or it ended
// early, follows the remedies that refusals name, and lets faults and commands happen.
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
  // Borrows all of them.
  RunOperator(const World& world, FiberScheduler& scheduler, SimulatedDisk& disk)
      : world_(world), scheduler_(scheduler), disk_(disk), clients_(world) {}

  // Begins and resumes the run until it has reached its end. Runs in a simulated thread.
  void Work();
  // Lets the faults happen, each at its time. Runs in a simulated thread of its own group.
  void Strike(const std::vector<Fault>& faults);

  // The run has reached its end.
  bool finished() const { return finished_; }
  // Whether a process did not leave in order in the last session.
  bool last_clean() const { return last_clean_; }
  int sessions() const { return sessions_; }
  // The end of the last fault, its span included.
  SteadyTime quiet_from() const { return quiet_from_; }

 private:
  void RunSession(Begin begin);
  void JudgeExit(const SimulatedProcess& coordinator);
  // Whether the session has said `text` since it began.
  bool Said(std::string_view text) const;
  // Whether it has named a process that failed, or a file.
  bool SaidWhoFailed() const;
  // Reads meta.json, whose env steps never become fewer.
  launch::RunMeta TakeMeta();
  // Does what comes before the next session; returns how that begins.
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
  bool began_on_full_disk_ = false;  // the session
  SteadyTime trouble_until_{};       // until then a session may end by itself (MayEndSessions)
  SteadyTime disk_full_until_{};     // of the full disk that was the last to end
  int sessions_ = 0, rivals_ = 0;
  ptrdiff_t session_begin_ = 0;    // its first line in the story
  const Fault* killed_ = nullptr;  // what killed the last coordinator
  std::string last_words_;
  uint64_t env_steps_ = 0;  // at the end of the last session
  SteadyTime quiet_from_{};
};

}  // namespace shoal::simulation
