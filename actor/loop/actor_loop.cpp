// SPDX-License-Identifier: Apache-2.0
#include "actor/loop/actor_loop.h"

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/wire/scoped_seconds.h"

namespace shoal::actor {

ActorLoop::End ActorLoop::Run(const Progress& progress) {
  RunControl& control = parts_.control;
  while (control.state() == RunState::kRunning && !control.StopRequested()) {
    if (control.CoordinatorLost(parts_.now())) {
      log::Failure("the coordinator is gone: no heartbeat; leaving");
      Drain(progress);
      return End::kCoordinatorLost;
    }
    const char* state = Advance();
    parts_.sender.Exchange(parts_.now());
    progress(state, /*last=*/false);
  }
  return Drain(progress) ? End::kAllStored : End::kUnstored;
}

// Runs one turn. Returns the state to report.
const char* ActorLoop::Advance() {
  const auto turn = parts_.pace.Next(parts_.rollout.vector_steps(), parts_.selector.version());
  if (turn == Pace::Turn::kAwaitWeights) {
    AwaitWeights();
    return "blocked";
  }
  awaiting_until_.reset();
  if (parts_.pace.TakesWeightsAnytime()) TakeWeights();
  if (turn == Pace::Turn::kRest || !parts_.rollout.TryStep()) AwaitCredit();
  return "running";
}

// Looks for the weights that the pace needs. The learner makes them from stored records.
void ActorLoop::AwaitWeights() {
  const SteadyTime now = parts_.now();
  if (!awaiting_until_) awaiting_until_ = now + parts_.pace.patience();
  if (now > *awaiting_until_) {
    throw RuntimeError("{} within {} s", parts_.pace.Awaited(), parts_.pace.patience().count());
  }
  parts_.sender.Flush();
  {
    const ScopedSeconds timed(weights_seconds_);
    parts_.sender.Exchange(now + kBlockedWait);
  }
  TakeWeights();
}

void ActorLoop::TakeWeights() {
  const auto weights = parts_.weights.TryTake();
  if (!weights) return;
  const ScopedSeconds timed(weights_seconds_);
  const uint64_t former = parts_.selector.version().session;
  parts_.selector.Load(*weights);
  if (former != 0 && former != weights->version.session && parts_.pace.BeginsAnewWithLearner()) {
    parts_.rollout.AbandonEpisodes();
  }
}

// The window is full or has no credit. Sends the records of open chunks, so that the replay can
// store them and grant more.
void ActorLoop::AwaitCredit() {
  const SteadyTime start = Now();
  const double publishing_before = parts_.sender.publish_seconds();
  parts_.sender.Flush();
  parts_.sender.Exchange(parts_.now() + kBlockedWait);
  blocked_seconds_ += SecondsSince(start) - (parts_.sender.publish_seconds() - publishing_before);
}

// Waits until every made record is stored. False if the deadline passes or stopping is requested
// again.
bool ActorLoop::Drain(const Progress& progress) {
  const ChunkWindow& window = parts_.sender.window();
  parts_.sender.Flush();
  const SteadyTime start = parts_.now();
  const int asked = parts_.control.StopRequests();
  while (window.Outstanding() > 0 && parts_.now() - start < kDrainDeadline &&
         parts_.control.StopRequests() == asked) {
    parts_.sender.Exchange(parts_.now() + kBlockedWait);
    progress("draining", /*last=*/false);
  }
  progress("stopping", /*last=*/true);
  if (window.Outstanding() == 0) {
    log::Info("stopped: {} records made, all stored", window.stored());
    return true;
  }
  const std::chrono::duration<double> waited = parts_.now() - start;
  log::Failure("stopped: {} of {} records were not acknowledged within {:.1f} s",
               window.Outstanding(), window.stored() + window.Outstanding(), waited.count());
  return false;
}

}  // namespace shoal::actor
