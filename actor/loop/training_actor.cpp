// SPDX-License-Identifier: Apache-2.0
#include "actor/loop/training_actor.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/base/host_name.h"
#include "common/base/log.h"
#include "common/base/write_faults.h"
#include "common/config/on_policy.h"
#include "common/config/run_files.h"
#include "common/config/sending_window.h"
#include "common/config/session_number.h"
#include "common/tasks/task_registry.h"
#include "common/wire/process_name.h"

namespace shoal::actor {
namespace {

using std::chrono::milliseconds;

// Covers the time in which a predecessor drains.
constexpr std::chrono::seconds kLockDeadline = ActorLoop::kDrainDeadline + std::chrono::seconds(15);
constexpr milliseconds kLastReportDeadline{500};

// Whether an actor continues its episodes exactly: in lockstep, if the receiver of the records
// remembers unfinished episodes.
bool GoesOnExactly(const Config& config) { return config.lockstep && !LearnsOnPolicy(config); }

ChunkWindow::Options WindowOptions(const RunConfig& run, uint32_t id, uint64_t session,
                                   uint64_t records_before) {
  const Config& config = run.config;
  const int record_bytes = RecordLayout(run.spec).record_bytes();
  CheckSendingWindow(config, record_bytes);
  const SendingWindow window = SendingWindowOf(config, record_bytes);
  return {.spec_hash = run.spec.Hash(),
          .actor = id,
          .session = session,
          .record_bytes = record_bytes,
          .chunk_records = window.chunk_records,
          .chunks = window.chunks + 1,
          .first_records = static_cast<uint64_t>(window.least_records),
          .records_before = records_before};
}

}  // namespace

TrainingActor::TrainingActor(const std::filesystem::path& folder, uint32_t id, link::Hub& hub,
                             const EnvironmentFactory& make)
    : run_(ReadRunConfig(folder)),
      lock_(folder, id, kLockDeadline, StopRequested),
      folder_(folder),
      id_(id),
      resumed_(GoesOnExactly(run_.config) ? TakeRolloutState(folder, id) : std::nullopt),
      session_(resumed_ ? resumed_->session
                        : NextSession(folder, ProcessName::Actor(id).Text(), WallTimeNs())),
      first_env_(id * static_cast<uint32_t>(run_.config.envs_per_actor)),
      made_(folder, id, session_, first_env_, static_cast<uint32_t>(run_.config.envs_per_actor)),
      window_(WindowOptions(run_, id, session_, resumed_ ? resumed_->made : 0)),
      selector_(run_.config, run_.spec, run_.config.envs_per_actor, id),
      rollout_(Rollout::Options::Of(run_.config, first_env_), run_.spec,
               make(run_, run_.config.envs_per_actor), made_, window_, selector_),
      metrics_(hub),
      link_(hub, id, session_),
      weights_(folder, HostName(), run_.spec.Hash(), WeightsOver(hub)),
      control_(hub),
      sender_(window_, link_,
              {.spec_hash = run_.spec.Hash(),
               .spec_summary = run_.spec.Summary(),
               .flush_after = milliseconds(run_.config.transport.flush_ms)}) {}

int TrainingActor::Run() {
  log::Info("session {}: environments {}..{}, {}", session_, first_env_,
            first_env_ + static_cast<uint32_t>(run_.config.envs_per_actor) - 1,
            run_.spec.Summary());
  if (resumed_) Restore();
  const auto pace = MakePace(run_.config, rollout_.vector_steps());
  ActorLoop loop({.rollout = rollout_,
                  .selector = selector_,
                  .sender = sender_,
                  .weights = weights_,
                  .pace = *pace,
                  .control = control_});
  ActorReport report(id_, {.rollout = rollout_,
                           .selector = selector_,
                           .sender = sender_,
                           .weights = weights_,
                           .loop = loop,
                           .task = tasks::FindTask(run_.config.task)});
  const ActorLoop::End end = RunLoop(loop, report);
  metrics_.WaitForAcks(kLastReportDeadline);
  const bool stored = end == ActorLoop::End::kAllStored;
  if (!stored) return 1;
  return GoesOnExactly(run_.config) && !Leave() ? kUnwrittenExit : 0;
}

ActorLoop::End TrainingActor::RunLoop(ActorLoop& loop, ActorReport& report) {
  try {
    return loop.Run([&](const char* state, bool last) {
      if (report.Due(Now()) || last) metrics_.Write(report.Make(state));
    });
  } catch (const SupersededError& e) {
    // This actor's successor needs a session above the one that superseded this actor.
    NextSession(folder_, ProcessName::Actor(id_).Text(),
                static_cast<int64_t>(std::min<uint64_t>(e.session(), INT64_MAX)));
    throw;
  }
}

void TrainingActor::Restore() {
  if (made_.made() != resumed_->made) {
    throw RuntimeError("actor {} made {} records, its state was left at {}", id_, made_.made(),
                       resumed_->made);
  }
  rollout_.Restore(*resumed_);
  log::Info("lockstep: goes on after {} env steps", rollout_.env_steps());
}

bool TrainingActor::Leave() {
  RolloutState state = rollout_.State();
  state.session = session_;
  state.made = made_.made();
  try {
    WriteRolloutState(folder_, id_, state);
    return true;
  } catch (const Error& e) {
    log::Failure("{}; the run will go on, but not repeat bit for bit", e.what());
    return false;
  }
}

}  // namespace shoal::actor
