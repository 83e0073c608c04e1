// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/simulated_processes.h"

#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <utility>

#include "common/base/check.h"
#include "common/base/log.h"
#include "common/base/main_guard.h"

namespace shoal::simulation {

// Lives on after its end or death, as its fibers may still refer to it.
class SimulatedProcesses::Process {
 public:
  Process(SimulatedProcesses& all, const launch::ProcessSpec& spec)
      : all_(all),
        spec_(spec),
        program_(std::filesystem::path(spec.command.at(0)).filename()),
        group_(spec.Name(), spec.output),
        hub_(all.network_.Join(*link::FindRole(spec.role))) {}

  void Start(const std::shared_ptr<Process>& self) {
    all_.scheduler_.StartIn(&group_, [self] { self->Run(); });
  }
  bool Kill() {
    if (ended_) return false;
    all_.scheduler_.Kill(&group_);
    all_.network_.Abandon(*hub_);
    (void)hub_.release();  // its ends belong to fibers that never run again
    ended_ = launch::ExitStatus{.by_signal = true, .code = SIGKILL};
    return true;
  }
  bool Pause(std::chrono::milliseconds span) {
    if (ended_) return false;
    all_.scheduler_.Pause(&group_, all_.scheduler_.Now() + span);
    return true;
  }
  void Signal(int signal) {
    if (signal == SIGKILL) {
      Kill();
    } else if (!ended_) {
      group_.RequestStop();
    }
  }
  std::optional<launch::ExitStatus> ended() const { return ended_; }

 private:
  void Run() {
    const int code = GuardBody(
        program_, [this] { return all_.body_(spec_, *hub_); },
        [this](const std::string& line) { log::WriteRaw(group_.log(), line); });
    hub_.reset();
    ended_ = launch::ExitStatus{.by_signal = false, .code = code};
  }

  SimulatedProcesses& all_;
  const launch::ProcessSpec spec_;
  const std::string program_;
  ThreadGroup group_;
  std::unique_ptr<link::Hub> hub_;
  std::optional<launch::ExitStatus> ended_;
};

class SimulatedProcesses::Handle final : public launch::RunningProcess {
 public:
  explicit Handle(std::shared_ptr<Process> process) : process_(std::move(process)) {}
  ~Handle() override { process_->Signal(SIGKILL); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  pid_t pid() const override { return getpid(); }
  std::optional<launch::ExitStatus> Poll() override { return process_->ended(); }
  void Signal(int signal) override { process_->Signal(signal); }

 private:
  const std::shared_ptr<Process> process_;
};

std::unique_ptr<launch::RunningProcess> SimulatedProcesses::Start(const launch::ProcessSpec& spec) {
  auto process = std::make_shared<Process>(*this, spec);
  process->Start(process);
  running_[spec.Name()] = process;
  return std::make_unique<Handle>(std::move(process));
}

bool SimulatedProcesses::Kill(const std::string& name) {
  const auto found = running_.find(name);
  return found != running_.end() && found->second->Kill();
}

bool SimulatedProcesses::Pause(const std::string& name, std::chrono::milliseconds span) {
  const auto found = running_.find(name);
  return found != running_.end() && found->second->Pause(span);
}

}  // namespace shoal::simulation
