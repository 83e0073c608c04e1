#include "actor/training_actor.h"

#include "actor/actor_lock.h"
#include "actor/credit_inbox.h"
#include "actor/rollout.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/stop.h"
#include "common/config/lockstep.h"
#include "common/config/run_membership.h"
#include "common/config/sending_window.h"
#include "common/config/session_number.h"
#include "common/dds/publisher.h"
#include "common/dds/subscriber.h"
#include "common/tasks/task_registry.h"
#include "common/wire/control_state.h"
#include "common/wire/metrics_report.h"
#include "common/wire/scoped_seconds.h"

namespace shoal::actor {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kResendAfter{2};  // without progress on what was sent
// For the last records to be stored. When the coordinator and with it the learner is gone, the
// limiter may hold them back until the replay has noticed, too.
constexpr seconds kDrainDeadline = ControlState::kLease + seconds(10);
constexpr seconds kLockDeadline = kDrainDeadline + seconds(15);  // for a predecessor to drain
constexpr milliseconds kBlockedWait{5};  // per look for credit while there is no room
constexpr seconds kLockstepDeadline{120};

ChunkWindow::Options WindowOptions(const RunConfig& run, uint32_t id, uint64_t session,
                                   uint64_t records_before) {
  const Config& config = run.config;
  const int record_bytes = RecordLayout(run.spec).record_bytes();
  const SendingWindow window = SendingWindowOf(config, record_bytes);
  if (2 * config.envs_per_actor > window.records()) {
    throw UsageError(
        "envs_per_actor {} does not fit the window of {} chunks of {} records: raise "
        "replay.window_chunks or transport.chunk_records",
        config.envs_per_actor, window.chunks, window.chunk_records);
  }
  return {.spec_hash = run.spec.Hash(),
          .actor = id,
          .session = session,
          .record_bytes = record_bytes,
          .chunk_records = window.chunk_records,
          .chunks = window.chunks + 1,
          .first_records = static_cast<uint64_t>(window.least_records),
          .records_before = records_before};
}

// Members are in construction order; destruction, the reverse, ends the receive threads' callbacks
// before the inboxes they write to.
class TrainingActor {
 public:
  TrainingActor(const std::filesystem::path& folder, uint32_t id, const dds::Reach& reach,
                const EnvironmentFactory& make)
      : member_(folder),
        run_(ReadRunConfig(folder)),
        lock_(folder, id, kLockDeadline, StopRequested),
        folder_(folder),
        id_(id),
        resumed_(run_.config.lockstep ? TakeRolloutState(folder, id) : std::nullopt),
        session_(resumed_ ? resumed_->session
                          : NextSession(folder, fmt::format("actor-{}", id), WallTimeNs())),
        first_env_(id * static_cast<uint32_t>(run_.config.envs_per_actor)),
        made_(folder, id, session_, first_env_, static_cast<uint32_t>(run_.config.envs_per_actor)),
        window_(WindowOptions(run_, id, session_, resumed_ ? resumed_->made : 0)),
        selector_(run_.config, run_.spec, run_.config.envs_per_actor),
        rollout_(run_.config, run_.spec, make(run_, run_.config.envs_per_actor), first_env_, made_,
                 window_, selector_),
        report_("actor", id),
        credits_(id, session_),
        weights_(run_.spec.Hash()),
        control_(Now()),
        bus_(dds::FindPlace(folder, run_.config.transport, reach), dds::Role::kActor),
        chunk_publisher_(bus_),
        metrics_publisher_(bus_),
        credit_subscriber_(bus_, [this](const CreditsMessage& m) { credits_.OnMessage(m); }),
        weights_subscriber_(bus_, [this](const WeightsMessage& m) { weights_.OnMessage(m); }),
        control_subscriber_(bus_,
                            [this](const ControlMessage& m) { control_.OnMessage(m, Now()); }) {}

  int Run() {
    log::Info("session {}: environments {}..{}, {}", session_, first_env_,
              first_env_ + static_cast<uint32_t>(run_.config.envs_per_actor) - 1,
              run_.spec.Summary());
    last_flush_ = last_progress_ = Now();
    if (resumed_) Resume();
    while (control_.state() == RunState::kRunning && !StopRequested()) {
      if (control_.CoordinatorLost(Now())) {
        log::Failure("the coordinator is gone: no heartbeat; leaving");
        Drain();
        return 1;
      }
      TakeWeights();
      Step();
      Exchange(Now());
      Report("running");
    }
    const bool stored = Drain();
    if (stored && run_.config.lockstep) {
      RolloutState state = rollout_.State();
      state.session = session_;
      state.made = made_.made();
      WriteRolloutState(folder_, id_, state);
    }
    return stored ? 0 : 1;
  }

 private:
  // In lockstep: goes on exactly where the former process left. Half-way through a phase it acted
  // by the weights of the phase before, which the learner offers first when it resumes.
  void Resume() {
    if (made_.made() != resumed_->made) {
      throw RuntimeError("actor {} made {} records, its state was left at {}", id_, made_.made(),
                         resumed_->made);
    }
    rollout_.Restore(*resumed_);
    const auto steps = static_cast<int64_t>(rollout_.env_steps()) / run_.config.envs_per_actor;
    while (LockstepVectorStepsAtPhaseEnd(run_.config, phase_) < steps) ++phase_;
    log::Info("lockstep: goes on after {} env steps, in phase {}", rollout_.env_steps(), phase_);
    const bool half_way = LockstepVectorStepsAtPhaseEnd(run_.config, phase_) > steps;
    if (half_way && phase_ > 0) {
      AwaitLockstepWeights(LockstepUpdatesAtPhaseEnd(run_.config, phase_ - 1));
    }
  }

  void TakeWeights() {
    if (run_.config.lockstep) {
      TakeLockstepWeights();
    } else if (const auto weights = weights_.TryTake()) {
      const ScopedSeconds timed(weights_seconds_);
      selector_.Load(*weights);
    }
  }

  // At the end of each phase everything made is stored, then the weights of that phase's last
  // update are waited for.
  void TakeLockstepWeights() {
    const auto steps = static_cast<int64_t>(rollout_.env_steps()) / run_.config.envs_per_actor;
    if (steps < LockstepVectorStepsAtPhaseEnd(run_.config, phase_)) return;
    const uint64_t wanted = LockstepUpdatesAtPhaseEnd(run_.config, phase_);
    window_.Flush();
    if (AwaitLockstepWeights(wanted)) ++phase_;
  }

  // False when the run ends first.
  bool AwaitLockstepWeights(uint64_t wanted) {
    const SteadyTime deadline = Now() + kLockstepDeadline;
    const ScopedSeconds timed(weights_seconds_);
    while (selector_.version().update < wanted) {
      if (StopRequested() || control_.state() != RunState::kRunning) return false;
      if (Now() > deadline) {
        throw RuntimeError("lockstep: no weights of update {} within {} s", wanted,
                           kLockstepDeadline.count());
      }
      Exchange(Now() + kBlockedWait);
      Report("blocked");
      if (const auto weights = weights_.TryTake()) selector_.Load(*weights);
    }
    return true;
  }

  // A lockstep run ends at the phase in which the budget is reached, whatever the clocks say.
  bool LockstepDone() const {
    return run_.config.lockstep && phase_ > 0 &&
           static_cast<int64_t>(rollout_.env_steps()) >= run_.config.env_steps &&
           rollout_.env_steps() / static_cast<uint64_t>(run_.config.envs_per_actor) ==
               static_cast<uint64_t>(LockstepVectorStepsAtPhaseEnd(run_.config, phase_ - 1));
  }

  void Step() {
    if (control_.state() != RunState::kRunning) return;
    if (!LockstepDone() && rollout_.TryStep()) return;
    const SteadyTime start = Now();
    const double publishing_before = publish_seconds_;
    window_.Flush();
    Exchange(start + kBlockedWait);
    blocked_seconds_ += SecondsSince(start) - (publish_seconds_ - publishing_before);
  }

  // Hears the replay (waiting for it until `deadline`) and sends what may be sent.
  void Exchange(SteadyTime deadline) {
    if (const auto credit = credits_.Take(deadline)) {
      if (credit->spec_hash != run_.spec.Hash()) {
        throw RuntimeError("the replay's observation spec {:016x} is not this actor's {:016x} [{}]",
                           credit->spec_hash, run_.spec.Hash(), run_.spec.Summary());
      }
      const uint64_t stored_before = window_.stored();
      window_.OnCredit(*credit);
      if (window_.stored() > stored_before) last_progress_ = Now();
    }
    if (Now() - last_flush_ >= milliseconds(run_.config.transport.flush_ms)) {
      window_.Flush();
      last_flush_ = Now();
    }
    if (!window_.HasUnstoredSent()) last_progress_ = Now();
    if (Now() - last_progress_ > kResendAfter) {
      window_.Rewind();
      last_progress_ = Now();
    }
    Send();
  }

  void Send() {
    const ScopedSeconds timed(publish_seconds_);
    // Without a matched reader a volatile writer's samples vanish.
    while (chunk_publisher_.Matched() > 0) {
      const auto chunk = window_.NextToSend();
      if (!chunk) break;
      if (!chunk_publisher_.Write(*chunk)) {
        ++write_timeouts_;
        break;
      }
      window_.MarkSent();
    }
  }

  // Until everything made is stored. False when the deadline came first.
  bool Drain() {
    window_.Flush();
    const SteadyTime start = Now();
    const int asked = StopRequests();  // asked once more: at once
    while (window_.Outstanding() > 0 && Now() - start < kDrainDeadline && StopRequests() == asked) {
      Exchange(Now() + kBlockedWait);
      Report("draining");
    }
    Report("stopping", /*now=*/true);
    metrics_publisher_.WaitForAcks(milliseconds(500));
    if (window_.Outstanding() == 0) {
      log::Info("stopped: {} records made, all stored", made_.made());
      return true;
    }
    log::Failure("stopped with {} of {} records not reported stored within {:.1f} s",
                 window_.Outstanding(), made_.made(), SecondsSince(start));
    return false;
  }

  void Report(const char* state, bool now = false) {
    if (!report_.Due(Now()) && !now) return;
    const auto env_steps = static_cast<double>(rollout_.env_steps());
    report_.Begin(state);
    report_.Add("env_steps", env_steps);
    report_.AddRate("env_steps_per_second", env_steps);
    report_.Add("made", static_cast<double>(made_.made()));
    report_.Add("outstanding", static_cast<double>(window_.Outstanding()));
    report_.Add("credit", static_cast<double>(window_.CreditLeft()));
    const auto oldest = window_.OldestUnstoredNs();
    report_.Add("queue_age_seconds",
                oldest ? 1e-9 * static_cast<double>(WallTimeNs() - *oldest) : 0);
    report_.Add("resends", static_cast<double>(window_.resent_records()));
    report_.Add("write_timeouts", static_cast<double>(write_timeouts_));
    report_.Add("weights_refused", static_cast<double>(weights_.refused()));
    report_.Add("weights_update", static_cast<double>(selector_.version().update));
    AddStages();
    AddEpisodes();
    report_.AddResources();
    metrics_publisher_.Write(report_.message());
  }

  void AddStages() {
    const StageSeconds stages = rollout_.seconds();
    report_.AddSeconds("physics", stages.physics);
    report_.AddSeconds("rendering", stages.rendering);
    report_.AddSeconds("inference", stages.inference);
    report_.AddSeconds("publishing", publish_seconds_);
    report_.AddSeconds("waiting_credit", blocked_seconds_);
    report_.AddSeconds("weights", weights_seconds_);
  }

  void AddEpisodes() {
    const EpisodeLog& episodes = rollout_.episodes();
    report_.Add("episodes", static_cast<double>(episodes.count()));
    if (episodes.count() == 0) return;
    const EpisodeFigures mean = episodes.Mean();
    const tasks::Task& task = tasks::FindTask(run_.config.task);
    if (task.has_success()) report_.Add("rollout_success", episodes.SuccessRate());
    report_.Add("rollout_return", mean.episode_return);
    report_.Add("rollout_length", mean.length);
    if (task.goal_size() > 0) report_.Add("rollout_final_distance", mean.final_distance);
    for (const worlds::DrawnMass& drawn : mean.drawn_masses) {
      report_.Add("rollout_mass_" + drawn.body, drawn.mass_kg);
    }
  }

  const RunMembership member_;
  const RunConfig run_;
  const ActorLock lock_;
  const std::filesystem::path folder_;
  const uint32_t id_;
  const std::optional<RolloutState> resumed_;  // lockstep
  const uint64_t session_;
  const uint32_t first_env_;
  MadePage made_;
  ChunkWindow window_;
  ActionSelector selector_;
  Rollout rollout_;
  MetricsReport report_;
  CreditInbox credits_;
  WeightsInbox weights_;
  ControlState control_;
  dds::Bus bus_;
  dds::Publisher<TransitionChunk> chunk_publisher_;
  dds::Publisher<MetricsMessage> metrics_publisher_;
  dds::Subscriber<CreditsMessage> credit_subscriber_;
  dds::Subscriber<WeightsMessage> weights_subscriber_;
  dds::Subscriber<ControlMessage> control_subscriber_;

  SteadyTime last_flush_, last_progress_;
  int64_t phase_ = 0;  // lockstep
  uint64_t write_timeouts_ = 0;
  double blocked_seconds_ = 0, publish_seconds_ = 0, weights_seconds_ = 0;
};

}  // namespace

int RunTrainingActor(const std::filesystem::path& run, uint32_t id, const dds::Reach& reach,
                     const EnvironmentFactory& make) {
  return TrainingActor(run, id, reach, make).Run();
}

}  // namespace shoal::actor
