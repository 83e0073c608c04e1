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
namespace {

constexpr std::chrono::milliseconds kSlowTurn{20};

}  // namespace

SimulatedProcess::SimulatedProcess(FiberScheduler& scheduler, link::LocalNetwork& network,
                                   link::Role role, const std::string& name,
                                   const std::string& log_file, bool outlives_parent)
    : scheduler_(scheduler),
      network_(network),
      name_(name),
      outlives_parent_(outlives_parent),
      group_(name, log_file),
      hub_(network.Join(role)) {}

void SimulatedProcess::Start(const std::shared_ptr<SimulatedProcess>& self,
                             const std::string& program, std::function<int(link::Hub&)> body) {
  self->scheduler_.StartIn(&self->group_, [self, program, body = std::move(body)] {
    const int code = GuardBody(
        program, [&] { return body(*self->hub_); },
        [&](const std::string& line) {
          self->last_words_ = line;
          log::WriteRaw(self->group_.log(), line);
        });
    self->hub_.reset();
    self->End({.by_signal = false, .code = code});
  });
}

void SimulatedProcess::End(launch::ExitStatus status) {
  ended_ = status;
  ended_at_ = scheduler_.NowOutside();
}

bool SimulatedProcess::Kill() {
  if (ended_) return false;
  scheduler_.Kill(&group_);
  if (hub_) {
    network_.Abandon(*hub_);
    (void)hub_.release();  // its ends belong to fibers that never run again
  }
  End({.by_signal = true, .code = SIGKILL});
  return true;
}

bool SimulatedProcess::Pause(std::chrono::milliseconds span) {
  if (!ended_) scheduler_.Pause(&group_, scheduler_.Now() + span);
  return !ended_;
}

bool SimulatedProcess::Stall(uint64_t which_thread, std::chrono::milliseconds span) {
  if (!ended_) scheduler_.Stall(&group_, which_thread, scheduler_.Now() + span);
  return !ended_;
}

bool SimulatedProcess::SlowDown(std::chrono::milliseconds span) {
  if (!ended_) scheduler_.SlowDown(&group_, kSlowTurn, scheduler_.Now() + span);
  return !ended_;
}

bool SimulatedProcess::Disconnect() {
  if (!ended_ && hub_) network_.Disconnect(*hub_);
  return !ended_;
}

bool SimulatedProcess::Reconnect() {
  if (!ended_ && hub_) network_.Reconnect(*hub_);
  return !ended_;
}

bool SimulatedProcess::RequestStop() {
  if (!ended_) group_.RequestStop();
  return !ended_;
}

class SimulatedProcesses::Handle final : public launch::RunningProcess {
 public:
  explicit Handle(std::shared_ptr<SimulatedProcess> process) : process_(std::move(process)) {}
  ~Handle() override { process_->Kill(); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  pid_t pid() const override { return getpid(); }
  std::optional<launch::ExitStatus> Poll() override { return process_->ended(); }
  void Signal(int signal) override {
    if (signal == SIGKILL) {
      process_->Kill();
    } else {
      process_->RequestStop();
    }
  }

 private:
  const std::shared_ptr<SimulatedProcess> process_;
};

std::unique_ptr<launch::RunningProcess> SimulatedProcesses::StartChild(
    const launch::ProcessSpec& spec) {
  auto process =
      std::make_shared<SimulatedProcess>(scheduler_, network_, *link::FindRole(spec.role),
                                         spec.Name(), spec.output, spec.outlives_parent);
  const std::string program = std::filesystem::path(spec.command.at(0)).filename();
  SimulatedProcess::Start(process, program,
                          [this, spec](link::Hub& hub) { return body_(spec, hub); });
  children_.push_back(process);
  newest_[spec.Name()] = process;
  return std::make_unique<Handle>(std::move(process));
}

std::shared_ptr<SimulatedProcess> SimulatedProcesses::StartOther(
    const std::string& name, link::Role role, const std::string& log_file,
    std::function<int(link::Hub&)> body) {
  auto process = std::make_shared<SimulatedProcess>(scheduler_, network_, role, name, log_file,
                                                    /*outlives_parent=*/true);
  SimulatedProcess::Start(process, "shoal", std::move(body));
  newest_[name] = process;
  return process;
}

std::shared_ptr<SimulatedProcess> SimulatedProcesses::Find(const std::string& name) const {
  const auto found = newest_.find(name);
  return found == newest_.end() || found->second->ended() ? nullptr : found->second;
}

void SimulatedProcesses::OnCoordinatorDeath() {
  for (const auto& child : children_) {
    if (!child->outlives_parent()) child->RequestStop();
  }
}

}  // namespace shoal::simulation
