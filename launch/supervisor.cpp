#include "launch/supervisor.h"

#include <fmt/core.h>

#include <utility>

namespace shoal::launch {
namespace {

bool Is(std::string_view role, const ProcessSpec& spec) {
  return role.empty() || role == spec.role;
}

// What starting again cannot cure: a refused configuration, numbers that are not finite any more.
bool Hopeless(const ExitStatus& status, const std::string& last_line) {
  if (status.by_signal) return false;
  return status.code == 2 || last_line.find("non-finite") != std::string::npos ||
         last_line.find("not finite") != std::string::npos;
}

std::string Describe(const ProcessSpec& spec, const ExitStatus& status,
                     const std::string& last_line) {
  return fmt::format("{}: {}{}{}", spec.Name(), status.Describe(), last_line.empty() ? "" : ": ",
                     last_line);
}

}  // namespace

Supervisor::Supervisor(const RestartLimits& limits, std::function<void(const std::string&)> say)
    : limits_(limits), say_(std::move(say)) {}

void Supervisor::Start(const ProcessSpec& spec) {
  Child child{.spec = spec,
              .policy = RestartPolicy(limits_),
              .process = ChildProcess(spec),
              .restart_at = std::nullopt};
  children_.push_back(std::move(child));
}

std::optional<std::string> Supervisor::Poll(SteadyTime now) {
  for (Child& child : children_) {
    if (child.process) {
      const auto status = child.process->Poll();
      if (!status) continue;
      child.process.reset();
      if (auto failure = OnExit(child, *status, now)) return failure;
    } else if (child.restart_at && now >= *child.restart_at) {
      child.restart_at.reset();
      child.process.emplace(child.spec);
      ++restarts_;
    }
  }
  return std::nullopt;
}

std::optional<std::string> Supervisor::OnExit(Child& child, const ExitStatus& status,
                                              SteadyTime now) {
  if (child.exit_expected) {
    OnExpectedExit(child, status);
    return std::nullopt;
  }
  const std::string last_line = LastLine(child.spec.output);
  const std::string death = Describe(child.spec, status, last_line);
  if (Hopeless(status, last_line)) return death;
  const auto delay = child.policy.OnDeath(now);
  if (!delay) {
    return fmt::format("{} (died more than {} times within {} s)", death, limits_.restarts,
                       limits_.window.count());
  }
  say_(fmt::format("{}; restart in {:.1f} s", death, static_cast<double>(delay->count()) / 1000));
  child.restart_at = now + *delay;
  return std::nullopt;
}

void Supervisor::OnExpectedExit(Child& child, const ExitStatus& status) {
  if (status.Clean()) return;
  // Having obeyed a signal of ours is as asked; SIGKILL came only after everything else was
  // ignored.
  const bool obeyed = status.by_signal && status.code == child.signalled;
  std::string line = Describe(child.spec, status, obeyed ? "" : LastLine(child.spec.output));
  line += " while stopping";
  say_(line);
  unclean_exits_.push_back(std::move(line));
}

void Supervisor::ExpectExit(std::string_view role) {
  for (Child& child : children_) {
    if (!Is(role, child.spec)) continue;
    child.exit_expected = true;
    child.restart_at.reset();
  }
}

void Supervisor::Signal(std::string_view role, int signal) {
  for (Child& child : children_) {
    if (!Is(role, child.spec) || !child.process) continue;
    child.signalled = signal;
    child.process->Signal(signal);
  }
}

int Supervisor::Running(std::string_view role) const {
  int running = 0;
  for (const Child& child : children_) {
    if (Is(role, child.spec) && (child.process || child.restart_at)) ++running;
  }
  return running;
}

}  // namespace shoal::launch
