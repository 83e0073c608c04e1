// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/run_operator.h"

#include <fmt/core.h>

#include <algorithm>
#include <csignal>
#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/sleep.h"
#include "common/base/stop.h"
#include "common/base/write_faults.h"
#include "common/config/run_membership.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/run_folder.h"

namespace shoal::simulation {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Kind = Fault::Kind;

constexpr milliseconds kLook{100};
constexpr seconds kTryAgain{3};
// More sessions than faults can make necessary.
constexpr int kMostSessions = 40;

// Faults of these kinds may end sessions with an error during the fault and for this time after it:
// a process cannot write, or processes get no messages from each other for longer than their
// timeouts. A ring that was cut off may do so from then on. A full disk ends only sessions that
// begin on it.
constexpr seconds kAftermath{60};
bool MayEndSessions(const Fault& fault) {
  return fault.kind == Kind::kFailingDisk || fault.kind == Kind::kPartition;
}

bool Ended(const std::string& exit) { return exit == "budget" || exit == "target"; }

}  // namespace

void RunOperator::Work() {
  Begin begin = Begin::kFresh;
  while (sessions_ < kMostSessions) {
    RunSession(begin);
    if (finished_) {
      WaitForChildren();
      return clients_.WaitForAll();
    }
    begin = Prepare();
  }
  world_.story.Violate(fmt::format("{} sessions have not brought the run to its end", sessions_));
}

void RunOperator::RunSession(Begin begin) {
  ++sessions_;
  began_on_full_disk_ = Now() < disk_full_until_;
  killed_ = nullptr;
  const char* how = begin == Begin::kFresh       ? "shoal train"
                    : begin == Begin::kOverwrite ? "shoal train --overwrite"
                                                 : "shoal train --resume";
  session_begin_ = static_cast<ptrdiff_t>(world_.story.lines().size());
  world_.story.Add("operator", how);
  std::optional<bool> clean;
  const auto coordinator = world_.processes.StartOther(
      "coordinator", link::Role::kCoordinator, world_.folder.string() + ".coordinator.log",
      [&, begin](link::Hub& hub) { return Train(world_, begin, hub, &clean); });
  while (!coordinator->ended()) SleepFor(kLook);
  last_clean_ = clean.value_or(true);
  JudgeExit(*coordinator);
}

void RunOperator::JudgeExit(const SimulatedProcess& coordinator) {
  last_words_ = coordinator.last_words();
  const launch::ExitStatus status = *coordinator.ended();
  const launch::RunMeta meta = TakeMeta();
  if (status.by_signal) return;
  world_.story.Add("coordinator", fmt::format("exit code {}{}{}", status.code,
                                              last_words_.empty() ? "" : ": ", last_words_));
  const int code = status.code;
  if (code != 0 && code != 1 && code != 2 && code != kUnwrittenExit && code != kInterruptedExit) {
    world_.story.Violate(fmt::format("exit code {} is not documented", code));
  }
  if (last_words_.find('\n') != std::string::npos)
    world_.story.Violate("the last words are not one line");
  // If a process was killed while the run stopped, the end is unclean and the exit code is 1. A
  // process that was killed during its own end had finished, too.
  const auto says = [this](const char* text) {
    return last_words_.find(text) != std::string::npos;
  };
  const bool unclean = code == 1 && !last_clean_ && SaidWhoFailed(),
             interrupted = code == kInterruptedExit;
  finished_ = Ended(meta.exit) &&
              (code == 0 || unclean || interrupted || (code == 2 && says("is finished")));
  // A command that failed while it stopped keeps its exit code (docs/failures.md).
  const bool stopped = interrupted || (meta.exit == "interrupted" && (code == 0 || unclean));
  // The end is noticed up to a second later.
  const bool full = Now() < disk_full_until_ + seconds(1);
  // The run reports unwritten files, and a resumed session writes them. An actor that starts on a
  // full disk cannot make its counter page. If actors die six times before one has worked, the run
  // ends.
  const bool unwritten = code == kUnwrittenExit || (code == 1 && SaidWhoFailed() && full);
  // A session may wait for earlier processes before its first write, or the disk may become full
  // between its first two writes.
  const bool began_full =
      began_on_full_disk_ || (full && (says(kConfigFile) || says(kClusterFile)));
  const bool troubled = Now() < trouble_until_ || began_full;
  // The learner of a run without a replay was killed after the budget was spent.
  const bool unspent = code == 1 && Said("env steps are left; --resume goes on");
  if (finished_ || stopped || unwritten || troubled || unspent) return;
  // Another process held the run for a moment, or a paused process has not left it yet.
  if (says("is running") || says("of an earlier session still works")) return;
  world_.story.Violate(fmt::format("a session ended as '{}' with code {}: {} {}", meta.exit, code,
                                   meta.error, last_words_));
}

bool RunOperator::Said(std::string_view text) const {
  const auto& lines = world_.story.lines();
  return std::any_of(lines.begin() + session_begin_, lines.end(), [text](const std::string& line) {
    return line.find(" coordinator: ") != std::string::npos && line.find(text) != std::string::npos;
  });
}

bool RunOperator::SaidWhoFailed() const { return Said(" while stopping") || Said("error: "); }

launch::RunMeta RunOperator::TakeMeta() {
  launch::RunMeta meta;
  try {
    meta = launch::ReadRunMeta(world_.folder);
  } catch (const Error& error) {
    world_.story.Violate(fmt::format("meta.json after a session: {}", error.what()));
    return meta;
  }
  if (meta.env_steps < env_steps_) {
    world_.story.Violate(
        fmt::format("{} env steps after a session, {} before it", meta.env_steps, env_steps_));
  }
  env_steps_ = meta.env_steps;
  return meta;
}

Begin RunOperator::Prepare() {
  if (killed_ == nullptr) {
    SleepFor(kTryAgain);
    if (last_words_.find(kRingFile) != std::string::npos) {
      world_.story.Add("operator", "removes the ring, as the refusal says");
      std::error_code ignored;
      std::filesystem::remove(world_.folder / kRingFile, ignored);
    }
    return NextBegin(Begin::kResume);
  }
  const Fault& fault = *killed_;
  SleepFor(fault.span);
  const std::filesystem::path ring = world_.folder / kRingFile;
  std::error_code error;
  if (fault.text == kThenLoseRing || fault.text == kThenCutRing) {
    WaitForChildren();
    const uintmax_t bytes = std::filesystem::file_size(ring, error);
    if (fault.text == kThenLoseRing) {
      std::filesystem::remove(ring, error);
    } else if (!error) {
      std::filesystem::resize_file(ring, bytes / 2, error);
      trouble_until_ = std::max(trouble_until_, Now() + kAftermath);
    }
  }
  return NextBegin(fault.text == kThenOverwrite ? Begin::kOverwrite : Begin::kResume);
}

// A coordinator that ends before there is a run leaves a folder that no command takes.
Begin RunOperator::NextBegin(Begin wanted) {
  const bool is_run = launch::IsRun(world_.folder);
  if (!is_run) {
    std::error_code ignored;
    WaitForChildren();
    std::filesystem::remove_all(world_.folder, ignored);
  }
  const Begin begin = is_run ? wanted : Begin::kFresh;
  if (begin != Begin::kResume) env_steps_ = 0;
  return begin;
}

void RunOperator::WaitForChildren() {
  while (AnyMember(world_.folder)) SleepFor(kLook);
}

void RunOperator::Strike(const std::vector<Fault>& faults) {
  const SteadyTime start = Now();
  for (const Fault& fault : faults) {
    SleepUntil(start + fault.at);
    if (finished_) return;
    Do(fault);
  }
}

void RunOperator::Do(const Fault& fault) {
  const auto process = world_.processes.Find(fault.process);
  const bool absent = !fault.process.empty() && process == nullptr;
  world_.story.Add("fault", fault.Text() + (absent ? " (it does not run)" : ""));
  if (absent) return;
  if (MayEndSessions(fault))
    trouble_until_ = std::max(trouble_until_, Now() + fault.span + kAftermath);
  const bool lasts = fault.kind != Kind::kClock && fault.kind != Kind::kCommand;
  quiet_from_ = std::max(quiet_from_, Now() + (lasts ? fault.span : milliseconds(0)));
  switch (fault.kind) {
    case Kind::kKill:
      if (fault.process == "coordinator") return KillCoordinator(fault, *process);
      process->Kill();
      return;
    case Kind::kPause:
      return Pause(fault, *process);
    case Kind::kStall:
      process->Stall(fault.number, fault.span);
      return;
    case Kind::kSlow:
      process->SlowDown(fault.span);
      return;
    case Kind::kPartition:
      process->Disconnect();
      After(fault.span, [process] { process->Reconnect(); });
      return;
    case Kind::kFullDisk:
      disk_full_until_ = std::max(disk_full_until_, Now() + fault.span);
      disk_.BeFull(disk_full_until_);
      return;
    case Kind::kFailingDisk:
      disk_.Fail(&process->group(), Now() + fault.span);
      return;
    case Kind::kClock:
      scheduler_.MoveWallClock(fault.span);
      return;
    case Kind::kCommand:
      return clients_.Begin(fault.text);
    case Kind::kAttach:
      return clients_.Attach(fault.span);
    case Kind::kSecond:
      return AskAsSecond();
    case Kind::kInterrupt:
      if (const auto coordinator = world_.processes.Find("coordinator")) {
        coordinator->RequestStop();
      }
      return;
  }
}

// Peers presume a process dead if it is silent for longer than the link's lease.
void RunOperator::Pause(const Fault& fault, SimulatedProcess& process) {
  process.Pause(fault.span);
  if (fault.span <= link::kLivenessLimit) return;
  const auto paused = world_.processes.Find(process.name());
  After(link::kLivenessLimit, [paused, span = fault.span] {
    paused->Disconnect();
    SleepFor(span - link::kLivenessLimit);
    paused->Reconnect();
  });
}

void RunOperator::KillCoordinator(const Fault& fault, SimulatedProcess& coordinator) {
  killed_ = &fault;
  coordinator.Kill();
  world_.processes.OnCoordinatorDeath();
}

void RunOperator::AskAsSecond() {
  const auto first = world_.processes.Find("coordinator");
  world_.processes.StartOther(fmt::format("second-{}", ++rivals_), link::Role::kClient,
                              world_.folder.string() + ".client.log", [this, first](link::Hub&) {
                                const bool held = launch::IsHeld(world_.folder);
                                try {
                                  AskForRun(world_);
                                } catch (const Error& error) {
                                  world_.story.Add("second", error.what());
                                  return error.exit_code();
                                }
                                world_.story.Add("second", "got the run");
                                if (held && first && !first->ended())
                                  world_.story.Violate("two coordinators have the run");
                                return 0;
                              });
}

void RunOperator::After(milliseconds span, std::function<void()> body) {
  const auto until = Now() + span;
  Thread([until, body = std::move(body)] {
    SleepUntil(until);
    body();
  });
}

}  // namespace shoal::simulation
