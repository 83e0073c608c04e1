// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/replay_service.h"

#include <algorithm>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/stop.h"
#include "common/base/usable_cores.h"
#include "common/config/live_values.h"
#include "common/config/run_files.h"
#include "common/config/session_number.h"
#include "common/intake/receiver_terms.h"
#include "common/run_folder/run_file_names.h"
#include "common/wire/scoped_seconds.h"

namespace shoal::replay {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPoll{100};  // between looks at control and stop requests
constexpr int kBatchBuffers = 2;    // one being filled, one being sent
constexpr milliseconds kProgressSpacing{200};
constexpr milliseconds kChoiceSpacing{250};

// Upper bound with replay.threads = 0. Only a learner on a GPU uses batches so fast that more than
// two or three threads are needed. Eight threads reach most of the bandwidth of the memory.
int MostGatherers() { return std::clamp(UsableCores() / 2, 1, 8); }

}  // namespace

ReplayService::ReplayService(const std::filesystem::path& folder, const ProcessName& name,
                             link::Hub& hub)
    : folder_(folder),
      name_(name),
      run_(ReadRunConfig(folder)),
      metrics_publisher_(hub),
      starting_report_(name),
      before_(ReadAccountBefore(folder)),
      core_(run_, folder, NextSession(folder, name.Text(), WallTimeNs()),
            {before_.stored_steps, before_.sessions}, [this] { ReportStarting(); }),
      session_clock_(core_.replay_session()),
      most_gatherers_(MostGatherers()),
      control_(Now()),
      inbox_(SpecHash(), ChunkBytes(Window(), core_.ring().layout().record_bytes()), MaxChunks()),
      problems_(SpecHash(), core_.batch_schema()),
      ages_(core_.ring().layout(), Settings().learner.request_credits),
      credit_publisher_(hub),
      progress_publisher_(hub),
      part_writer_(hub),
      sender_(SpecHash(), core_.batch_schema().total_bytes(), kBatchBuffers, &part_writer_,
              [this] { inbox_.Wake(); }),
      // One slot for each batch that may be requested, and one for the batch that the learner
      // reads.
      slots_(SpecHash(), core_.batch_schema().total_bytes(),
             static_cast<uint32_t>(Settings().learner.request_credits) + 1),
      gatherers_(std::max(1, Settings().replay.threads), [this] { inbox_.Wake(); }),
      in_work_(&gatherers_),
      report_(name, core_, inbox_, sender_, slots_, gatherers_),
      control_subscriber_(hub, [this](const ControlMessage& m) { control_.OnMessage(m, Now()); }),
      request_subscriber_(hub, [this](const SampleRequest& r) { inbox_.OnRequest(r); }),
      chunk_subscriber_(hub, [this](const TransitionChunk& c) { inbox_.OnChunk(c); }) {}

int ReplayService::Run() {
  const Ring& ring = core_.ring();
  log::Info("ring of {} records, {:.0f} MB, {}; {} records of the run stored, {} sampleable",
            ring.capacity(), static_cast<double>(ring.bytes()) / 1e6, Settings().replay.storage,
            ring.last_id(), core_.index().sampleable());
  if (core_.ring_replaced()) {
    log::Warning(
        "records of earlier servers are lost ({}); env steps continue from {}; training continues "
        "when the replay holds {} sampleable transitions again (replay.min_size)",
        Settings().replay.storage == "memory" ? "replay.storage=memory" : "the file is another one",
        ring.stored_steps(), Settings().replay.min_size);
  }
  last_turn_ = last_choice_ = Now();
  int exit_code = 0;
  while (!StopRequested() && control_.state() != RunState::kStopping) {
    if (control_.CoordinatorLost(Now())) {
      log::Failure("the coordinator is gone: no heartbeat; leaving");
      DrainAfterCoordinatorLoss();
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

const Config& ReplayService::Settings() const { return run_.config; }

uint64_t ReplayService::SpecHash() const { return run_.spec.Hash(); }

SendingWindow ReplayService::Window() const {
  return SendingWindowOf(Settings(), core_.ring().layout().record_bytes());
}

size_t ReplayService::MaxChunks() const {
  const size_t known = core_.sessions().newest().size();
  const int actors = LiveValuesOf(Settings(), control_).actors;
  const size_t sessions = std::max(known, static_cast<size_t>(std::clamp(actors, 1, 1'000'000)));
  return MostChunks(Window(), sessions);
}

void ReplayService::RefuseMoreSessions() {
  throw UsageError(
      "the replay can count {} actor sessions in a run, and all are used: no actor can join or "
      "restart; start a new run with fewer actors",
      kMaxSessions);
}

void ReplayService::ReportStarting() {
  if (!starting_report_.Due(Now())) return;
  starting_report_.Begin("starting");
  starting_report_.AddResources();
  metrics_publisher_.Write(starting_report_.message());
}

void ReplayService::Turn() {
  const bool inserts_blocked = core_.InsertsBlocked(), samples_blocked = core_.SamplesBlocked();
  Take(WaitForArrivals());
  Answer();
  WorkOnBatches();
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
  ChooseGatherers(now);
  if (report_.Due(now)) Report(core_.draining() ? "draining" : "running");
}

void ReplayService::TellChangedCredits(SteadyTime now) {
  const auto spacing = CreditSpacing(core_.sessions().newest().size());
  credits_wait_ = !core_.CreditsUrgent() && now - last_told_ < spacing;
  if (credits_wait_) return;
  last_told_ = now;
  Publish(core_.TakeCredits(/*changed_only=*/true));
}

void ReplayService::TellProgress(SteadyTime now, bool at_once) {
  const ReplayProgress progress{.replay = name_.index,
                                .session = core_.replay_session(),
                                .stored_steps = core_.ring().stored_steps(),
                                .stored_records = core_.ring().last_id()};
  if (progress_told_ && progress.stored_records == told_records_ && !at_once) return;
  if (progress_told_ && now - *progress_told_ < kProgressSpacing && !at_once) return;
  if (!progress_publisher_.Write(progress)) return;
  progress_told_ = now;
  told_records_ = progress.stored_records;
}

void ReplayService::ApplySettings() {
  const LiveValues values = LiveValuesOf(Settings(), control_);
  if (values.env_steps != core_.budget()) log::Info("env_steps is now {}", values.env_steps);
  core_.SetBudget(values.env_steps);
  if (values.samples_per_insert == core_.limiter().samples_per_insert()) return;
  log::Info("replay.samples_per_insert is now {}",
            values.samples_per_insert.At(core_.ring().stored_steps()));
  core_.SetSamplesPerInsert(values.samples_per_insert);
}

ServiceInbox::Arrivals ReplayService::WaitForArrivals() {
  // A batch that other threads copy counts as sampling, as if this thread copied it.
  const ScopedSeconds timed(in_work_.empty() ? seconds_.idle : seconds_.sampling);
  if (gatherers_.HasWork()) return inbox_.Wait(Now());
  return inbox_.Wait(Now() + (credits_wait_ ? kCreditSpacing : kPoll));
}

void ReplayService::Take(ServiceInbox::Arrivals arrivals) {
  const ScopedSeconds timed(seconds_.inserting);
  for (std::unique_ptr<PooledChunk>& pooled : arrivals.chunks) {
    TakeChunk(*pooled);
    inbox_.Release(std::move(pooled));
  }
  for (const SampleRequest& request : arrivals.requests) TakeRequest(request);
  sender_.SetLearnerSession(core_.requests().learner_session());
}

void ReplayService::TakeChunk(const PooledChunk& pooled) {
  const TransitionChunk& chunk = pooled.chunk;
  // The records of the chunk overwrite the oldest records, which batches may still copy.
  const uint64_t last = core_.ring().last_id() + chunk.count, capacity = core_.ring().capacity();
  if (last > capacity) in_work_.FinishReadersUpTo(last - capacity);
  const ChunkResult result = core_.TakeChunk(chunk, session_clock_.Latest(WallTimeNs()));
  problems_.Note(chunk, result);
  report_.NoteQueueAge(SecondsSince(pooled.arrived));
  if (result.fate == ChunkFate::kDealtWith) ages_.OnChunk(chunk, WallTimeNs());
  if (result.fate == ChunkFate::kWrongSpec || result.fate == ChunkFate::kSuperseded) {
    Publish({core_.Refusal(chunk)});
  }
  if (chunk.count > 0) last_chunk_ = Now();
}

void ReplayService::TakeRequest(const SampleRequest& request) {
  const RequestFate fate = core_.TakeRequest(request);
  if (fate == RequestFate::kWrongSpec || fate == RequestFate::kWrongSchema) {
    return problems_.NoteRefused(request);
  }
  if (fate == RequestFate::kQueued || fate == RequestFate::kAlreadyQueued) {
    ages_.OnRequest(request);
  }
  if (fate == RequestFate::kStale) return;
  if (slots_.GivesUp(request)) {
    // Nothing may write to the slots when their memory is gone.
    in_work_.Finish();
    AnnounceComplete();
  }
  slots_.OnRequest(request);
}

void ReplayService::Answer() {
  const auto answer = [this] {
    SlotWriter* slots = slots_.writer();
    return slots != nullptr ? AnswerInSlot(*slots) : AnswerInBuffer();
  };
  while (answer()) {
  }
}

bool ReplayService::AnswerInBuffer() {
  uint8_t* buffer = sender_.FreeBuffer();
  if (buffer == nullptr) return false;
  std::optional<BegunBatch> begun = Draw(buffer);
  if (!begun) return false;
  const DrawnBatch batch = begun->batch;
  const ScopedSeconds timed(seconds_.sampling);
  in_work_.Add(*std::move(begun));
  in_work_.Finish();
  in_work_.TakeComplete();
  sender_.Send(batch, buffer);
  return true;
}

bool ReplayService::AnswerInSlot(SlotWriter& slots) {
  // The learner may still be reading the slot of a batch that it requests again, so the slot stays.
  const std::optional<SampleRequest> again = core_.NextRepeated();
  if (const auto held = again ? slots.Held(again->request) : std::nullopt) {
    core_.AnsweredAgain();
    sender_.Send(*held);
    return true;
  }
  if (again && in_work_.Has(again->request)) {
    core_.AnsweredAgain();  // its slot is announced when it is full
    return true;
  }
  uint8_t* slot = slots.FreeSlot();
  if (slot == nullptr) return false;
  std::optional<BegunBatch> begun = Draw(slot);
  if (!begun) return false;
  slots.Reserve(begun->batch.request.request);
  in_work_.Add(*std::move(begun));
  return true;
}

std::optional<BegunBatch> ReplayService::Draw(uint8_t* data) {
  const ScopedSeconds timed(seconds_.sampling);
  std::optional<BegunBatch> begun = core_.BeginAnswer(data);
  if (begun) ages_.OnBatch(core_.last_plan(), core_.ring(), WallTimeNs());
  return begun;
}

void ReplayService::WorkOnBatches() {
  if (in_work_.empty()) return;
  const ScopedSeconds timed(seconds_.sampling);
  gatherers_.Help();
  AnnounceComplete();
}

void ReplayService::AnnounceComplete() {
  SlotWriter* slots = slots_.writer();
  for (const DrawnBatch& batch : in_work_.TakeComplete()) {
    CHECK(slots != nullptr) << "request " << batch.request.request;
    sender_.Send(slots->Fill(batch.request.request, batch.stored_records, batch.stored_steps,
                             batch.unsampleable_steps));
    report_.NoteSlotBatch();
  }
}

void ReplayService::Publish(const std::vector<Credit>& credits) {
  if (!credits.empty()) credit_publisher_.Write({credits});
}

void ReplayService::ChooseGatherers(SteadyTime now) {
  if (Settings().replay.threads > 0 || now - last_choice_ < kChoiceSpacing) return;
  const double seconds = std::chrono::duration<double>(now - last_choice_).count();
  const double copying = gatherers_.seconds();
  const double share = (copying - copying_then_) / (seconds * gatherers_.threads());
  last_choice_ = now;
  copying_then_ = copying;
  gatherers_.Resize(GatherThreadsFor(share, gatherers_.threads(), most_gatherers_));
}

void ReplayService::Report(const char* state) {
  metrics_publisher_.Write(report_.Make(state, seconds_, &ages_));
  problems_.Report(Now(), core_.counters(), inbox_.DroppedChunks());
  faults_.Try(kAccountingFile, [this] { ReplaceAccount(folder_, AccountNow()); });
}

RunAccount ReplayService::AccountNow() const {
  return {.stored_steps = core_.ring().stored_steps(),
          .stored_records = core_.ring().last_id(),
          .ring_replaced = before_.ring_replaced || core_.ring_replaced(),
          .sessions = core_.sessions().all()};
}

void ReplayService::DrainAfterCoordinatorLoss() {
  const SteadyTime start = Now();
  last_chunk_ = start;
  core_.SetDraining(true);
  while (Now() - last_chunk_ < kFarewell && Now() - start < kFarewellLimit && !StopRequested()) {
    Turn();
  }
}

bool ReplayService::Finish() {
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

}  // namespace shoal::replay
