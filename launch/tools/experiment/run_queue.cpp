// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/run_queue.h"

#include <fmt/core.h>

#include <algorithm>
#include <deque>
#include <optional>
#include <set>

namespace shoal::launch {
namespace {

class Queue {
 public:
  Queue(const std::vector<ExperimentRun>& runs, const QueueTerms& terms, RunKeeper& keeper,
        const QueueHooks& hooks)
      : terms_(terms),
        keeper_(keeper),
        hooks_(hooks),
        waiting_(runs.begin(), runs.end()),
        count_(runs.size()),
        slots_(static_cast<size_t>(terms.jobs)) {}

  void Do() {
    int answered = 0;  // stop requests that have been passed on
    while (true) {
      CollectEnded();
      if (hooks_.stops() == 0) FillSlots();
      if (Idle() && (waiting_.empty() || hooks_.stops() > 0)) return;
      for (; answered < hooks_.stops(); ++answered) keeper_.Stop();
      hooks_.wait();
    }
  }

 private:
  bool Idle() const {
    return std::ranges::none_of(slots_, [](const auto& slot) { return slot.has_value(); });
  }

  void CollectEnded() {
    for (size_t slot = 0; slot < slots_.size(); ++slot) {
      if (!slots_[slot] || !keeper_.Ended(static_cast<int>(slot))) continue;
      const ExperimentRun run = *slots_[slot];
      slots_[slot].reset();
      Finish(run, keeper_.Standing(run));
    }
  }

  void FillSlots() {
    for (size_t slot = 0; slot < slots_.size(); ++slot) {
      while (!slots_[slot] && StartNext(slot)) {
      }
    }
  }

  // Takes one run from the queue and starts it in the slot, or settles it without a start. Returns
  // false if no run can start now.
  bool StartNext(size_t slot) {
    for (auto run = waiting_.begin(); run != waiting_.end(); ++run) {
      const StandingReport report = keeper_.Standing(*run);
      if (report.standing == ExperimentRunStatus::kRunning) {
        PutOff(*run);
        continue;
      }
      const ExperimentRun taken = *run;
      waiting_.erase(run);
      if (report.standing == ExperimentRunStatus::kFinished) {
        Finish(taken, report);
      } else if (report.standing == ExperimentRunStatus::kFailed && !terms_.retry_failed) {
        hooks_.say(fmt::format("{}: failed before ({}); --retry-failed tries again", Label(taken),
                               report.problem));
        hooks_.done(taken, report);
      } else {
        Begin(taken, slot, report.standing);
      }
      return true;
    }
    return false;
  }

  void Begin(const ExperimentRun& run, size_t slot, ExperimentRunStatus standing) {
    const char* const what = standing == ExperimentRunStatus::kMissing  ? "begins"
                             : standing == ExperimentRunStatus::kFailed ? "is tried again"
                                                                        : "goes on";
    hooks_.say(fmt::format("{}: {}", Label(run), what));
    keeper_.Start(run, static_cast<int>(slot));
    slots_[slot] = run;
  }

  void PutOff(const ExperimentRun& run) {
    if (!put_off_.insert(run.name).second) return;
    hooks_.say(fmt::format("{}: another process still holds it; waiting for its end", Label(run)));
  }

  void Finish(const ExperimentRun& run, const StandingReport& report) {
    std::string line = fmt::format("{}: {}", Label(run), ToString(report.standing));
    if (!report.problem.empty()) line += ": " + report.problem;
    if (report.standing != ExperimentRunStatus::kFinished && hooks_.stops() == 0) {
      line += waiting_.empty() ? "" : "; going on with the next";
    }
    hooks_.say(line);
    hooks_.done(run, report);
  }

  std::string Label(const ExperimentRun& run) {
    if (std::ranges::find(seen_, run.name) == seen_.end()) seen_.push_back(run.name);
    const auto place = std::ranges::find(seen_, run.name) - seen_.begin() + 1;
    return fmt::format("[{}/{}] {}", place, count_, run.name);
  }

  const QueueTerms terms_;
  RunKeeper& keeper_;
  const QueueHooks& hooks_;
  std::deque<ExperimentRun> waiting_;
  const size_t count_;
  std::vector<std::optional<ExperimentRun>> slots_;  // the run of each slot
  std::set<std::string> put_off_;                    // runs whose delay was reported
  std::vector<std::string> seen_;                    // names of runs, in order
};

}  // namespace

void DoRuns(const std::vector<ExperimentRun>& runs, const QueueTerms& terms, RunKeeper& keeper,
            const QueueHooks& hooks) {
  Queue(runs, terms, keeper, hooks).Do();
}

}  // namespace shoal::launch
