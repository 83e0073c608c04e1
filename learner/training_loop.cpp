// SPDX-License-Identifier: Apache-2.0
#include "learner/training_loop.h"

#include <algorithm>
#include <utility>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/sleep.h"
#include "common/base/stop.h"
#include "common/config/live_values.h"
#include "common/config/lockstep.h"
#include "common/config/on_policy.h"
#include "common/config/priorities.h"
#include "common/wire/scoped_seconds.h"

namespace shoal::learner {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPoll{100};            // longest time between looks at control
constexpr milliseconds kBlockedAfter{1'000};  // without a batch

}  // namespace

TrainingLoop::TrainingLoop(const Parts& parts, const std::optional<CheckpointState>& restored)
    : parts_(parts),
      config_(parts_.run.config),
      weights_(parts.run, parts.precision, parts.session, parts.agent, parts.sink),
      evaluations_(parts.run, parts.session, restored ? restored->env_steps : 0, parts.agent,
                   parts.sink),
      report_(parts.name, parts.run),
      on_policy_(LearnsOnPolicy(config_)),
      has_priorities_(HasPriorities(config_.replay)),
      sample_errors_(config_.replay.copies),
      finite_updates_(parts_.agent.updates()),
      threads_(parts.threads),
      threads_asked_(parts.threads),
      budget_(static_cast<uint64_t>(config_.env_steps)),
      samples_per_insert_(config_.replay.samples_per_insert),
      granted_from_steps_(static_cast<uint64_t>(config_.replay.min_size)),
      waiting_since_(Now()) {
  if (!restored) return;
  env_steps_ = restored->env_steps;
  request_ = restored->request;
  checkpoint_of_ = restored->updates;
}

TrainingLoop::End TrainingLoop::Run() {
  // On policy, GiveAwaitedWeights sends the restored weights.
  if (parts_.agent.updates() > 0 && !on_policy_) weights_.Send(env_steps_);
  bool lost = false;
  while (!lost && !StopRequested() && parts_.control.state() != RunState::kStopping) {
    ApplySettings();
    if (on_policy_) GiveAwaitedWeights();
    if (parts_.control.state() == RunState::kDraining) {
      Drain();
    } else {
      TryTrain();
    }
    evaluations_.Retry();
    RetryCheckpoint();
    Report();
    lost = parts_.control.CoordinatorLost(Now());
  }
  stopping_ = true;
  Report(/*now=*/true);
  if (parts_.agent.updates() > 0) WriteCheckpoint();
  RetryCheckpoint(/*now=*/true);
  Report(/*now=*/true);
  log::Info("stopped after {} updates, {} env steps", parts_.agent.updates(), env_steps_);
  return lost ? End::kCoordinatorLost : End::kStopped;
}

bool TrainingLoop::TryTrain() {
  std::optional<Batch> batch;
  {
    const ScopedSeconds timed(seconds_.waiting);
    batch = parts_.batches.Next(Now() + kPoll);
  }
  if (!batch) {
    FinishUpdates();  // the report of an idle learner lacks no update
    return false;
  }
  const std::vector<UpdateOutcome> outcomes = Submit(*batch);
  report_.OnBatch(*batch, parts_.agent.updates());
  OnOutcomes(outcomes);
  AfterUpdate(*batch);
  waiting_since_ = Now();
  return true;
}

std::vector<UpdateOutcome> TrainingLoop::Submit(const Batch& batch) {
  if (has_priorities_) sample_errors_.OnBatch(batch);
  SteadyTime since = Now();
  updating_ = true;
  std::vector<UpdateOutcome> outcomes = parts_.agent.Submit(batch.view, [&](UpdateStage stage) {
    const SteadyTime now = Now();
    seconds_.update[static_cast<size_t>(stage)] +=
        std::chrono::duration<double>(now - std::exchange(since, now)).count();
    // An update of a whole rollout may take a minute, and a silent process is taken for hung.
    if (on_policy_) Report();
  });
  updating_ = false;
  return outcomes;
}

void TrainingLoop::FinishUpdates() {
  OnOutcomes(parts_.agent.Finish());
  weights_.SendCopied(finite_updates_);
}

void TrainingLoop::OnOutcomes(const std::vector<UpdateOutcome>& outcomes) {
  for (const UpdateOutcome& outcome : outcomes) {
    if (!outcome.finite) {
      const std::optional<uint64_t> saved = parts_.checkpoints.WrittenUpdates();
      throw NonFiniteError("{}; last good checkpoint: {}",
                           DescribeNonFinite(outcome.figures, finite_updates_),
                           saved ? CheckpointName(*saved) : "none");
    }
    parts_.update_page.SetDone(++finite_updates_);
    report_.OnUpdate(outcome.figures);
    if (has_priorities_) parts_.batches.TakeErrors(sample_errors_.TakeOldest(outcome.errors));
  }
}

void TrainingLoop::AfterUpdate(const Batch& batch) {
  const uint64_t updates = parts_.agent.updates();
  env_steps_ = batch.view.stored_steps;
  unsampleable_steps_ = batch.unsampleable_steps;
  request_ = batch.request;
  if (on_policy_) {
    TellProgress();  // the budget counts whole rollouts
    GiveAwaitedWeights();
  } else {
    SendDueWeights();
  }
  if (evaluations_.Reached(env_steps_)) {
    MakeEvaluationPoint();
  } else if (updates % static_cast<uint64_t>(config_.learner.checkpoint_period) == 0) {
    WriteCheckpoint();
  }
}

void TrainingLoop::SendDueWeights() {
  const ScopedSeconds timed(seconds_.weights);
  weights_.SendCopied(finite_updates_);
  if (!weights_.DueAfterUpdate()) return;
  weights_.Begin(env_steps_);
  if (config_.lockstep) FinishUpdates();  // the actors wait for these weights
  weights_.SendCopied(finite_updates_);
}

void TrainingLoop::GiveAwaitedWeights() {
  const ScopedSeconds timed(seconds_.weights);
  FinishUpdates();
  if (given_weights_ == parts_.agent.updates()) return weights_.Retry(env_steps_);
  // Without new weights the actors begin no further rollout.
  if (env_steps_ >= budget_ || drain_start_) return;
  given_weights_ = parts_.agent.updates();
  weights_.Send(env_steps_);
}

void TrainingLoop::MakeEvaluationPoint() {
  const std::string name = WriteCheckpoint();
  parts_.pending_evaluations.Add(parts_.agent.updates(), name);
  evaluations_asked_.push_back(
      {.update = parts_.agent.updates(), .env_steps = env_steps_, .checkpoint = name});
  if (evaluations_asked_.size() > LearnerProgress::kMostEvaluations) {
    evaluations_asked_.erase(evaluations_asked_.begin());
  }
  TellProgress();  // announced first: an evaluation that was not announced is refused
  const ScopedSeconds timed(seconds_.weights);
  evaluations_.Send(name, env_steps_);
}

void TrainingLoop::TellProgress() {
  parts_.sink.Publish(LearnerProgress{.session = parts_.session,
                                      .updates = parts_.agent.updates(),
                                      .env_steps = env_steps_,
                                      .drained = drained_,
                                      .evaluations = evaluations_asked_});
}

std::string TrainingLoop::WriteCheckpoint() {
  const ScopedSeconds timed(seconds_.checkpoint);
  FinishUpdates();
  const uint64_t updates = parts_.agent.updates();
  if (checkpoint_of_ == updates) return CheckpointName(updates);
  const CheckpointState state{.updates = updates,
                              .env_steps = env_steps_,
                              .request = request_,
                              .learner_session = parts_.session,
                              .config_hash = parts_.checkpoints.config_hash(),
                              .spec_hash = parts_.run.spec.Hash(),
                              .precision = nn::ToString(parts_.precision),
                              .algorithm = config_.learner.algorithm};
  std::string name = parts_.checkpoints.Write(state, parts_.agent.AllTensors(),
                                              parts_.agent.AveragedPolicyTensors(),
                                              parts_.pending_evaluations.Names());
  checkpoint_of_ = updates;
  if (parts_.checkpoints.unwritten() == 0) ++checkpoints_written_;
  return name;
}

void TrainingLoop::RetryCheckpoint(bool now) {
  const ScopedSeconds timed(seconds_.checkpoint);
  parts_.checkpoints.Retry(parts_.pending_evaluations.Names(), now);
}

void TrainingLoop::Drain() {
  if (!drain_start_) {
    drain_start_ = waiting_since_ = Now();
    log::Info("draining");
  }
  if (drained_) {  // the parameters must stay those of the last evaluation point
    SleepFor(kPoll);
    return;
  }
  if (!on_policy_) {
    if (TryTrain()) ++drain_batches_;
    if (!DrainingIsOver()) return;
  }
  drained_ = true;
  if (parts_.agent.updates() > 0 && evaluations_.last_updates() != parts_.agent.updates()) {
    MakeEvaluationPoint();
  }
  TellProgress();
  log::Info("drained after {} updates, {} env steps", parts_.agent.updates(), env_steps_);
}

bool TrainingLoop::DrainingIsOver() const {
  const SteadyTime now = Now();
  if (now - *drain_start_ > kDrainMost || now - waiting_since_ > parts_.drain_idle) return true;
  if (config_.lockstep) return parts_.agent.updates() >= LockstepLastUpdate(config_);
  // Up to request_credits batches may have been drawn before draining began.
  return drain_batches_ > config_.learner.request_credits && RatioReached();
}

double TrainingLoop::GrantedSamples(uint64_t env_steps) const {
  const uint64_t steps = std::max(env_steps, granted_from_steps_);
  return granted_before_ + samples_per_insert_.Integral(granted_from_steps_, steps);
}

bool TrainingLoop::RatioReached() const {
  const uint64_t sampled_from = env_steps_ - std::min(env_steps_, unsampleable_steps_);
  return static_cast<double>(parts_.agent.updates()) * config_.learner.batch >=
         GrantedSamples(sampled_from);
}

void TrainingLoop::ApplySettings() {
  const LiveValues values = LiveValuesOf(config_, parts_.control);
  budget_ = values.env_steps;
  parts_.batches.SetActors(values.actors);
  weights_.SetPeriod(values.weights_period);
  evaluations_.SetInterval(values.eval_interval, env_steps_);
  ApplyThreads(values.learner_threads.value_or(threads_asked_));
  if (values.samples_per_insert == samples_per_insert_) return;
  // A new ratio applies to later steps only; earlier ones keep their grant.
  granted_before_ = GrantedSamples(env_steps_);
  granted_from_steps_ = std::max(env_steps_, granted_from_steps_);
  samples_per_insert_ = values.samples_per_insert;
}

void TrainingLoop::ApplyThreads(int asked) {
  if (asked == threads_asked_ || parts_.resize == nullptr || on_policy_) return;
  threads_asked_ = asked;
  FinishUpdates();
  threads_ = parts_.resize(asked);
}

void TrainingLoop::Report(bool now) {
  if (!report_.Due() && !now) return;
  const LearnerFigures figures{.state = State(),
                               .updates = parts_.agent.updates(),
                               .env_steps = env_steps_,
                               .weights_sent = weights_.sent(),
                               .weights_unsent = weights_.unsent(),
                               .evaluations_overtaken = evaluations_.overtaken(),
                               .checkpoints = checkpoints_written_,
                               .checkpoints_unwritten = parts_.checkpoints.unwritten(),
                               .eval_updates = evaluations_.last_updates(),
                               .drained = drained_,
                               .samples_per_insert = samples_per_insert_.At(env_steps_),
                               .eval_interval = static_cast<double>(evaluations_.interval()),
                               .weights_period = static_cast<double>(weights_.period()),
                               .budget = static_cast<double>(budget_),
                               .threads = threads_,
                               .card = parts_.look == nullptr ? std::nullopt : parts_.look(),
                               .seconds = seconds_,
                               .batches = parts_.batches.counters()};
  TellProgress();
  parts_.sink.Publish(report_.Make(figures));
}

const char* TrainingLoop::State() const {
  if (stopping_) return "stopping";
  if (drain_start_) return "draining";
  if (updating_) return "running";
  if (parts_.agent.updates() == 0) return "starting";
  return Now() - waiting_since_ > kBlockedAfter ? "blocked" : "running";
}

}  // namespace shoal::learner
