// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/replay_service.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/saturating_cast.h"
#include "common/base/stop.h"
#include "common/base/write_faults.h"
#include "common/config/run_files.h"
#include "common/config/run_membership.h"
#include "common/config/sending_window.h"
#include "common/config/session_number.h"
#include "common/dds/bus.h"
#include "common/dds/metrics_publisher.h"
#include "common/dds/publisher.h"
#include "common/dds/subscriber.h"
#include "common/intake/receiver_terms.h"
#include "common/run_folder/accounting_file.h"
#include "common/run_folder/run_file_names.h"
#include "common/wire/control_state.h"
#include "common/wire/metrics_report.h"
#include "common/wire/process_name.h"
#include "common/wire/scoped_seconds.h"
#include "replay_server/core/replay_core.h"
#include "replay_server/service/batch_sender.h"
#include "replay_server/service/dds_part_writer.h"
#include "replay_server/service/flow_ages.h"
#include "replay_server/service/learner_slots.h"
#include "replay_server/service/problem_log.h"
#include "replay_server/service/service_inbox.h"
#include "replay_server/service/service_report.h"

namespace shoal::replay {
namespace {

using std::chrono::milliseconds;

constexpr ProcessName kProcess = ProcessName::Replay(0);
constexpr milliseconds kPoll{100};  // between looks at control and stop requests
constexpr int kBatchBuffers = 2;    // one being filled, one being sent
constexpr milliseconds kProgressSpacing{200};

// Members are in construction order; destruction, the reverse, ends the receive threads' callbacks
// and the sender before what they use.
class ReplayService {
 public:
  ReplayService(const std::filesystem::path& folder, const dds::Reach& reach)
      : folder_(folder),
        member_(folder),
        run_(ReadRunConfig(folder)),
        bus_(dds::FindPlace(folder, run_.config.transport, reach), dds::Role::kReplay),
        metrics_publisher_(bus_),
        before_(ReadAccountBefore(folder)),
        core_(run_, folder, NextSession(folder, kProcess.Text(), WallTimeNs()),
              {before_.stored_steps, before_.sessions}, [this] { ReportStarting(); }),
        control_(Now()),
        inbox_(SpecHash(), ChunkBytes(Window(), core_.ring().layout().record_bytes()), MaxChunks()),
        problems_(SpecHash(), core_.batch_schema()),
        ages_(core_.ring().layout(), Settings().learner.request_credits),
        credit_publisher_(bus_),
        progress_publisher_(bus_),
        part_writer_(bus_),
        sender_(SpecHash(), core_.batch_schema().total_bytes(), kBatchBuffers, &part_writer_,
                [this] { inbox_.Wake(); }),
        // One for each batch that the learner may have asked for, one for that which it reads.
        slots_(SpecHash(), core_.batch_schema().total_bytes(),
               static_cast<uint32_t>(Settings().learner.request_credits) + 1),
        report_(core_, inbox_, sender_, slots_),
        control_subscriber_(bus_,
                            [this](const ControlMessage& m) { control_.OnMessage(m, Now()); }),
        request_subscriber_(bus_, [this](const SampleRequest& r) { inbox_.OnRequest(r); }),
        chunk_subscriber_(bus_, [this](const TransitionChunk& c) { inbox_.OnChunk(c); }) {}

  int Run() {
    const Ring& ring = core_.ring();
    log::Info("ring of {} records, {:.0f} MB, {}; {} records of the run stored, {} sampleable",
              ring.capacity(), static_cast<double>(ring.bytes()) / 1e6, Settings().replay.storage,
              ring.last_id(), core_.index().sampleable());
    if (core_.ring_replaced()) {
      log::Warning(
          "records that earlier servers had stored are gone ({}); env steps go on from {}; "
          "refilling "
          "to {} sampleable transitions (replay.min_size) before training goes on",
          Settings().replay.storage == "memory" ? "replay.storage=memory"
                                                : "the file is another one",
          ring.stored_steps(), Settings().replay.min_size);
    }
    last_turn_ = Now();
    int exit_code = 0;
    while (!StopRequested() && control_.state() != RunState::kStopping) {
      if (control_.CoordinatorLost(Now())) {
        log::Failure("the coordinator is gone: no heartbeat; leaving");
        SayFarewell();
        exit_code = 1;
        break;
      }
      core_.SetDraining(control_.state() == RunState::kDraining);
      Turn();
      if (core_.counters().intake.table_full_chunks > 0) break;
    }
    const bool written = Finish();
    if (core_.counters().intake.table_full_chunks > 0) RefuseMoreSessions();
    return exit_code == 0 && !written ? kUnwrittenExit : exit_code;
  }

 private:
  const Config& Settings() const { return run_.config; }
  uint64_t SpecHash() const { return run_.spec.Hash(); }
  SendingWindow Window() const {
    return SendingWindowOf(Settings(), core_.ring().layout().record_bytes());
  }
  size_t MaxChunks() const {
    const size_t known = core_.sessions().newest().size();
    const double actors = control_.SettingOr("actors", Settings().actors);
    const size_t sessions = std::max(known, SaturatingCast<size_t>(std::clamp(actors, 1.0, 1e6)));
    return MostChunks(Window(), sessions);
  }

  // A restart would find the same full table.
  [[noreturn]] static void RefuseMoreSessions() {
    throw UsageError(
        "the replay keeps the accounts of {} actor sessions over a run and there were as many: no "
        "actor can join or be restarted any more; start a new run, with fewer actors",
        kMaxSessions);
  }

  // Reading a cold ring takes minutes, in which a process that says nothing would be taken for
  // hung.
  void ReportStarting() {
    if (!starting_report_.Due(Now())) return;
    starting_report_.Begin("starting");
    starting_report_.AddResources();
    metrics_publisher_.Write(starting_report_.message());
  }

  // One turn of the service: takes what came, answers one request, tells what has changed.
  void Turn() {
    const bool inserts_blocked = core_.InsertsBlocked(), samples_blocked = core_.SamplesBlocked();
    Take(WaitForArrivals(answered_ ? Now() : Now() + (credits_wait_ ? kCreditSpacing : kPoll)));
    AnswerOne();
    const SteadyTime now = Now();
    TellChangedCredits(now);
    const double elapsed = std::chrono::duration<double>(now - last_turn_).count();
    if (inserts_blocked) seconds_.blocked_insert += elapsed;
    if (samples_blocked) seconds_.blocked_sample += elapsed;
    last_turn_ = now;
    if (now - last_credits_ >= kCreditInterval) {
      last_credits_ = now;
      Publish(core_.TakeCredits(/*changed_only=*/false));
      inbox_.SetMaxChunks(MaxChunks());
    }
    TellProgress(now);
    ApplySettings();
    if (report_.Due(now)) Report(control_.state() == RunState::kDraining ? "draining" : "running");
  }

  void TellChangedCredits(SteadyTime now) {
    const auto spacing = CreditSpacing(core_.sessions().newest().size());
    credits_wait_ = !core_.CreditsUrgent() && now - last_told_ < spacing;
    if (credits_wait_) return;
    last_told_ = now;
    Publish(core_.TakeCredits(/*changed_only=*/true));
  }

  // What the coordinator counts the run's env steps by.
  void TellProgress(SteadyTime now, bool at_once = false) {
    const ReplayProgress progress{.replay = kProcess.index,
                                  .session = core_.replay_session(),
                                  .stored_steps = core_.ring().stored_steps(),
                                  .stored_records = core_.ring().last_id()};
    if (progress_told_ && progress.stored_records == told_records_ && !at_once) return;
    if (progress_told_ && now - *progress_told_ < kProgressSpacing && !at_once) return;
    if (!progress_publisher_.Write(progress)) return;
    progress_told_ = now;
    told_records_ = progress.stored_records;
  }

  void ApplySettings() {
    const auto budget = SaturatingCast<uint64_t>(
        control_.SettingOr("env_steps", static_cast<double>(Settings().env_steps)));
    if (budget != core_.budget()) log::Info("env_steps is now {}", budget);
    core_.SetBudget(budget);
    const std::optional<double> set = control_.Setting("replay.samples_per_insert");
    const Schedule samples = set ? Schedule::Constant(*set) : Settings().replay.samples_per_insert;
    if (samples == core_.limiter().samples_per_insert()) return;
    log::Info("replay.samples_per_insert is now {}", samples.At(core_.ring().stored_steps()));
    core_.SetSamplesPerInsert(samples);
  }

  ServiceInbox::Arrivals WaitForArrivals(SteadyTime deadline) {
    const ScopedSeconds timed(seconds_.idle);
    return inbox_.Wait(deadline);
  }

  void Take(ServiceInbox::Arrivals arrivals) {
    const ScopedSeconds timed(seconds_.inserting);
    for (std::unique_ptr<PooledChunk>& pooled : arrivals.chunks) {
      const ChunkResult result = core_.TakeChunk(pooled->chunk, LatestSession());
      problems_.Note(pooled->chunk, result);
      report_.NoteQueueAge(SecondsSince(pooled->arrived));
      if (result.fate == ChunkFate::kDealtWith) ages_.OnChunk(pooled->chunk, WallTimeNs());
      if (result.fate == ChunkFate::kWrongSpec || result.fate == ChunkFate::kSuperseded) {
        Publish({core_.Refusal(pooled->chunk)});
      }
      if (pooled->chunk.count > 0) last_chunk_ = Now();
      inbox_.Release(std::move(pooled));
    }
    for (const SampleRequest& request : arrivals.requests) {
      const RequestFate fate = core_.TakeRequest(request);
      if (fate == RequestFate::kWrongSpec || fate == RequestFate::kWrongSchema) {
        problems_.NoteRefused(request);
        continue;
      }
      if (fate == RequestFate::kQueued || fate == RequestFate::kAlreadyQueued) {
        ages_.OnRequest(request);
      }
      if (fate != RequestFate::kStale) slots_.OnRequest(request);
    }
    sender_.SetLearnerSession(core_.requests().learner_session());
  }

  void AnswerOne() {
    SlotWriter* slots = slots_.writer();
    answered_ = slots != nullptr ? AnswerInSlot(*slots) : AnswerInBuffer();
  }

  bool AnswerInBuffer() {
    uint8_t* buffer = sender_.FreeBuffer();
    if (buffer == nullptr) return false;
    const std::optional<DrawnBatch> batch = Draw(buffer);
    if (batch) sender_.Send(*batch, buffer);
    return batch.has_value();
  }

  bool AnswerInSlot(SlotWriter& slots) {
    // The learner may be reading the slot of a batch that it asked for again: it stays as it is.
    const std::optional<SampleRequest> again = core_.NextRepeated();
    if (const auto held = again ? slots.Held(again->request) : std::nullopt) {
      core_.AnsweredAgain();
      sender_.Send(*held);
      return true;
    }
    uint8_t* slot = slots.FreeSlot();
    if (slot == nullptr) return false;
    const std::optional<DrawnBatch> batch = Draw(slot);
    if (!batch) return false;
    sender_.Send(slots.Fill(batch->request.request, batch->stored_records, batch->stored_steps,
                            batch->unsampleable_steps));
    report_.NoteSlotBatch();
    return true;
  }

  std::optional<DrawnBatch> Draw(uint8_t* data) {
    const ScopedSeconds timed(seconds_.sampling);
    const std::optional<DrawnBatch> batch = core_.TryAnswer(data);
    if (batch) ages_.OnBatch(core_.last_plan(), core_.ring(), WallTimeNs());
    return batch;
  }

  void Publish(const std::vector<Credit>& credits) {
    if (!credits.empty()) credit_publisher_.Write({credits});
  }

  void Report(const char* state) {
    metrics_publisher_.Write(report_.Make(state, seconds_, &ages_));
    problems_.Report(Now(), core_.counters(), inbox_.DroppedChunks());
    faults_.Try(kAccountingFile, [this] { ReplaceAccount(folder_, AccountNow()); });
  }

  RunAccount AccountNow() const {
    return {.stored_steps = core_.ring().stored_steps(),
            .stored_records = core_.ring().last_id(),
            .ring_replaced = before_.ring_replaced || core_.ring_replaced(),
            .sessions = core_.sessions().all()};
  }

  // The actors notice the coordinator's end too, and send what they have: it is stored.
  void SayFarewell() {
    const SteadyTime start = Now();
    last_chunk_ = start;
    core_.SetDraining(true);
    while (Now() - last_chunk_ < kFarewell && Now() - start < kFarewellLimit && !StopRequested()) {
      Turn();
    }
  }

  // False when the account could not be written.
  bool Finish() {
    Take(inbox_.Wait(Now()));
    Publish(core_.TakeCredits(/*changed_only=*/false));
    TellProgress(Now(), /*at_once=*/true);
    metrics_publisher_.Write(report_.Make("stopping", seconds_, &ages_));
    const bool written =
        faults_.Try(kAccountingFile, [this] { StoreAccount(folder_, AccountNow()); });
    metrics_publisher_.WaitForAcks(milliseconds(500));
    credit_publisher_.WaitForAcks(milliseconds(500));
    log::Info("stopped: {} records of the run stored, {} batches drawn", core_.ring().last_id(),
              core_.counters().batches);
    return written;
  }

  const std::filesystem::path folder_;
  const RunMembership member_;
  const RunConfig run_;
  dds::Bus bus_;
  dds::MetricsPublisher<ReplayMetrics> metrics_publisher_;
  MetricsReport starting_report_{kProcess};
  const RunAccount before_;
  ReplayCore core_;
  ControlState control_;
  ServiceInbox inbox_;
  ProblemLog problems_;
  FlowAges ages_;
  dds::Publisher<CreditsMessage> credit_publisher_;
  dds::Publisher<ReplayProgress> progress_publisher_;
  DdsPartWriter part_writer_;
  BatchSender sender_;
  LearnerSlots slots_;
  ServiceReport report_;
  dds::Subscriber<ControlMessage> control_subscriber_;
  dds::Subscriber<SampleRequest> request_subscriber_;
  dds::Subscriber<TransitionChunk> chunk_subscriber_;

  WriteFaults faults_{[](const std::string& line) { log::Warning("{}", line); }};
  ServiceSeconds seconds_;
  SteadyTime last_turn_{}, last_credits_{}, last_chunk_{};
  SteadyTime last_told_{};
  std::optional<SteadyTime> progress_told_;
  uint64_t told_records_ = 0;
  bool credits_wait_ = false;  // words about credit are being collected
  bool answered_ = false;      // a batch in the last turn: there may be another one to draw
};

}  // namespace

int RunReplayService(const std::filesystem::path& folder, const dds::Reach& reach) {
  KeepSecuredRunPrivate(folder);
  return ReplayService(folder, reach).Run();
}

}  // namespace shoal::replay
