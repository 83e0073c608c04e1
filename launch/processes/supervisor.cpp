// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/supervisor.h"

#include <fmt/core.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <limits>
#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/write_faults.h"
#include "launch/processes/exit_reason.h"

namespace shoal::launch {
namespace {

// Exit code of ssh if the connection fails; its other codes are those of the remote program.
constexpr int kDisconnected = 255;

// An unreachable host may return, so reconnecting never gives up.
constexpr std::chrono::seconds kReconnect{10};  // longest delay between two attempts

RestartLimits ConnectionLimits(RestartLimits limits) {
  limits.restarts = std::numeric_limits<int>::max();
  limits.longest_delay = kReconnect;
  return limits;
}

bool Is(std::string_view role, const ProcessSpec& spec) {
  return role.empty() || role == spec.role;
}

bool IsNonFinite(const ExitStatus& status) {
  return !status.by_signal && status.code == static_cast<int>(ErrorKind::kNonFinite);
}

// Whether a restart cannot help: the configuration was refused, or numbers are not finite.
bool Hopeless(const ExitStatus& status) {
  return IsNonFinite(status) ||
         (!status.by_signal && status.code == static_cast<int>(ErrorKind::kUsage));
}

bool IsDisconnected(const ProcessSpec& spec, const ExitStatus& status) {
  return spec.elsewhere && !status.by_signal && status.code == kDisconnected;
}

std::string TooOften(const RestartLimits& limits) {
  return fmt::format(" (died more than {} times within {} s)", limits.restarts,
                     limits.window.count());
}

std::string Describe(const ExitStatus& status, const std::string& exit_reason) {
  return fmt::format("{}{}{}", status.Describe(), exit_reason.empty() ? "" : ": ", exit_reason);
}

double Seconds(std::chrono::milliseconds delay) {
  return static_cast<double>(delay.count()) / 1000;
}

}  // namespace

Supervisor::Supervisor(const RestartLimits& limits, const HangLimits& hang_limits,
                       std::function<void(const std::string&)> say, ProcessStarter start)
    : limits_(limits), hang_limits_(hang_limits), say_(std::move(say)), start_(std::move(start)) {}

void Supervisor::Start(const ProcessSpec& spec) {
  const SteadyTime now = Now();
  CHECK(std::ranges::none_of(children_, [&](const Child& child) {
    return child.spec.Name() == spec.Name() && !child.exit_expected;
  })) << spec.Name();
  for (Child& child : children_) {
    if (child.spec.Name() != spec.Name() || !child.exit_expected || !child.process) continue;
    child.successor = spec;
    return;
  }
  std::erase_if(children_, [&](const Child& child) {  // entries of retired children
    return child.spec.Name() == spec.Name() && child.exit_expected && !child.process;
  });
  Child child{.spec = spec,
              .policy = RestartPolicy(limits_),
              .connection = RestartPolicy(ConnectionLimits(limits_)),
              .process = nullptr,
              .liveness = LivenessTimer(now),
              .heard_since = std::nullopt,
              .restart_at = std::nullopt,
              .down = {},
              .leave_by = std::nullopt,
              .successor = std::nullopt};
  Launch(child, now);
  children_.push_back(std::move(child));
}

void Supervisor::Retire(std::string_view role, int id, SteadyTime now) {
  for (Child& child : children_) {
    if (child.spec.role != role || child.spec.id != id) continue;
    child.successor.reset();
    child.restart_at.reset();
    if (child.exit_expected) continue;
    child.exit_expected = true;
    child.leave_by = now + kRetire;
    child.signalled = SIGTERM;
    if (child.process) child.process->Signal(SIGTERM);
  }
}

void Supervisor::Launch(Child& child, SteadyTime now) {
  std::error_code none;
  const uintmax_t before = std::filesystem::file_size(child.spec.output, none);
  child.output_before = none ? 0 : before;
  child.process = start_(child.spec);
  child.liveness = LivenessTimer(now);
  child.heard_since.reset();
  child.hung = false;
}

void Supervisor::Heard(std::string_view role, int id, pid_t pid, SteadyTime now) {
  for (Child& child : children_) {
    if (child.spec.role != role || child.spec.id != id) continue;
    if (!child.process || (child.process->pid() != pid && !child.spec.elsewhere)) continue;
    child.liveness.Heard(now);
    if (!child.heard_since) child.heard_since = now;
  }
}

std::optional<std::string> Supervisor::Poll(SteadyTime now) {
  for (Child& child : children_) {
    if (child.process) {
      const auto status = child.process->Poll();
      if (!status) {
        KillIfHung(child, now);
        KillIfOverdue(child, now);
        continue;
      }
      child.process.reset();
      if (auto failure = OnExit(child, *status, now)) return failure;
    } else if (child.restart_at && now >= *child.restart_at) {
      child.restart_at.reset();
      Launch(child, now);
      ++restarts_;
    }
  }
  return std::nullopt;
}

void Supervisor::KillIfOverdue(Child& child, SteadyTime now) {
  if (!child.leave_by || now < *child.leave_by) return;
  child.leave_by.reset();
  say_(fmt::format("{} (pid {}) did not leave within {} s: killed", child.spec.Name(),
                   child.process->pid(), kRetire.count()));
  child.process->Signal(SIGKILL);
}

// Leaves out processes that are being stopped: the ordered stop has deadlines of its own.
void Supervisor::KillIfHung(Child& child, SteadyTime now) {
  if (child.exit_expected || child.hung) return;
  const std::chrono::seconds limit = child.heard_since ? hang_limits_.report : hang_limits_.start;
  if (child.liveness.Look(now) <= limit) return;
  child.hung = true;
  say_(fmt::format("{} (pid {}) hangs: no report for {} s; killed", child.spec.Name(),
                   child.process->pid(), limit.count()));
  child.process->Signal(SIGKILL);  // also ends a process stopped by SIGSTOP
}

std::optional<std::string> Supervisor::OnExit(Child& child, const ExitStatus& status,
                                              SteadyTime now) {
  if (child.exit_expected) {
    OnExpectedExit(child, status);
    child.leave_by.reset();
    if (child.successor) {
      child.spec = *std::exchange(child.successor, std::nullopt);
      child.exit_expected = false;
      child.signalled = 0;
      Launch(child, now);
    }
    return std::nullopt;
  }
  const std::string reason = Describe(status, ExitReason(child.spec.output, child.output_before));
  const std::string death = fmt::format("{}: {}", child.spec.Name(), reason);
  if (child.spec.expendable && !IsNonFinite(status)) {
    BackOff(child, status, reason, now);
    return std::nullopt;
  }
  if (Hopeless(status)) return death;
  const auto delay =
      (IsDisconnected(child.spec, status) ? child.connection : child.policy).OnDeath(now);
  if (!delay) return death + TooOften(limits_);
  say_(fmt::format("{}; restart in {:.1f} s", death, Seconds(*delay)));
  child.restart_at = now + *delay;
  return std::nullopt;
}

void Supervisor::BackOff(Child& child, const ExitStatus& status, const std::string& reason,
                         SteadyTime now) {
  const auto worked = child.heard_since ? now - *child.heard_since : SteadyTime::duration::zero();
  const bool settled = worked >= kSettled;
  RestartBackoff::Restart restart =
      child.backoff.OnDeath(std::chrono::duration_cast<std::chrono::milliseconds>(worked));
  if (settled) child.down.hopeless.clear();
  if (IsDisconnected(child.spec, status)) {
    restart.delay = std::min<std::chrono::milliseconds>(restart.delay, kReconnect);
  } else if (Hopeless(status)) {
    child.down.hopeless = reason;
  } else if (!child.policy.OnDeath(now)) {
    child.down.hopeless = reason + TooOften(limits_);
  }
  child.down.name = child.spec.Name();
  child.down.reason = reason;
  child.down.deaths = restart.deaths;
  ++child.deaths;
  child.restart_at = now + restart.delay;
  if (!restart.announce) return;
  std::string line =
      fmt::format("{}: {}; restart in {:.1f} s", child.down.name, reason, Seconds(restart.delay));
  if (restart.deaths > 1) {
    line += fmt::format(" (death {} in a row; death {} is reported next)", restart.deaths,
                        2 * restart.deaths);
  }
  say_(line);
}

RoleStanding Supervisor::Standing(std::string_view role, SteadyTime now) const {
  RoleStanding standing;
  for (const Child& child : children_) {
    if (child.spec.role != role || !child.spec.expendable || child.exit_expected) continue;
    ++standing.processes;
    if (child.process && child.heard_since && now - *child.heard_since >= kSettled) {
      ++standing.working;
    } else if (child.down.deaths > 0) {
      standing.down.push_back(child.down);
      if (!child.restart_at) continue;
      standing.down.back().restart_in = std::chrono::ceil<std::chrono::seconds>(
          std::max(*child.restart_at - now, SteadyTime::duration::zero()));
    }
  }
  return standing;
}

std::string Supervisor::DescribeDeaths() const {
  constexpr size_t kNamed = 5;
  std::vector<const Child*> died;
  for (const Child& child : children_) {
    if (child.deaths > 0) died.push_back(&child);
  }
  std::ranges::stable_sort(died, std::ranges::greater(), &Child::deaths);
  std::string text;
  for (size_t i = 0; i < std::min(died.size(), kNamed); ++i) {
    text += fmt::format("{}{} {} time{} (last: {})", i == 0 ? "" : "; ", died[i]->spec.Name(),
                        died[i]->deaths, died[i]->deaths == 1 ? "" : "s", died[i]->down.reason);
  }
  if (died.size() > kNamed) text += fmt::format("; and {} more", died.size() - kNamed);
  return text;
}

void Supervisor::OnExpectedExit(Child& child, const ExitStatus& status) {
  // A program that handles a stop signal ends by that signal, and so does a program that had not
  // installed a handler yet. SIGKILL is an unclean exit: all earlier signals were ignored.
  const bool ours = status.by_signal && status.code == child.signalled;
  if (status.Clean() || (ours && status.code != SIGKILL)) return;
  const std::string reason =
      Describe(status, ours ? "" : ExitReason(child.spec.output, child.output_before));
  std::string line = fmt::format("{}: {} while stopping", child.spec.Name(), reason);
  say_(line);
  if (!status.by_signal && status.code == kUnwrittenExit) {
    unwritten_exits_.insert(child.spec.Name());
    return;
  }
  unclean_exits_.push_back(std::move(line));
}

void Supervisor::ExpectExit(std::string_view role) {
  for (Child& child : children_) {
    if (!Is(role, child.spec)) continue;
    // The process will not be replaced, so its work stays unfinished.
    if (child.restart_at && !child.spec.expendable) {
      unclean_exits_.push_back(
          fmt::format("{}: died and is not restarted while stopping", child.spec.Name()));
      say_(unclean_exits_.back());
    }
    child.exit_expected = true;
    child.restart_at.reset();
    child.successor.reset();
  }
}

void Supervisor::Signal(std::string_view role, int signal) {
  for (Child& child : children_) {
    if (!Is(role, child.spec) || !child.process) continue;
    child.signalled = signal;
    child.process->Signal(signal);
  }
}

pid_t Supervisor::Pid(std::string_view role, int id) const {
  for (const Child& child : children_) {
    if (child.spec.role == role && child.spec.id == id && child.process)
      return child.process->pid();
  }
  return 0;
}

int Supervisor::Running(std::string_view role) const {
  int running = 0;
  for (const Child& child : children_) {
    if (Is(role, child.spec) && (child.process || child.restart_at)) ++running;
  }
  return running;
}

}  // namespace shoal::launch
