// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/replay_core.h"

#include <algorithm>
#include <utility>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/config/batch_options.h"
#include "common/config/priorities.h"
#include "common/config/sending_window.h"
#include "common/config/sequences.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::replay {
namespace {

RingOptions OptionsOfRing(const Config& config, const std::filesystem::path& folder,
                          uint64_t steps_before, const StartupProgress& progress) {
  RingOptions options;
  options.progress = progress;
  if (config.replay.storage == "file") options.file = folder / kRingFile;
  options.capacity = static_cast<uint64_t>(config.replay.capacity);
  options.run = config.run_name;
  options.steps_before = steps_before;
  return options;
}

uint64_t WindowRecords(const RunConfig& run) {
  const int record_bytes = RecordLayout(run.spec).record_bytes();
  return static_cast<uint64_t>(SendingWindowOf(run.config, record_bytes).records());
}

uint64_t LeastRecords(const RunConfig& run) {
  const int record_bytes = RecordLayout(run.spec).record_bytes();
  return static_cast<uint64_t>(SendingWindowOf(run.config, record_bytes).least_records);
}

LimiterOptions OptionsOfLimiter(const RunConfig& run) {
  const Config& config = run.config;
  LimiterOptions options;
  options.samples_per_insert = config.replay.samples_per_insert;
  options.min_size = static_cast<uint64_t>(config.replay.min_size);
  options.batch = config.learner.batch;
  options.credits = config.learner.request_credits;
  options.window_records = WindowRecords(run);
  options.waiting_steps = WaitingSteps(run);
  options.band = config.replay.band;
  options.lockstep = config.lockstep;
  const double least = RateLimiter::LeastBand(options, std::max(1, config.actors));
  if (options.band > 0 && options.band < least) {
    throw UsageError(
        "replay.band {} is too small: actors and learner could wait for each other; with {} actors "
        "at least {} (0 = computed)",
        options.band, std::max(1, config.actors), least);
  }
  return options;
}

SessionTable SessionsOf(Ring& ring, const FormerServer& former) {
  SessionTable sessions(ring.sessions());
  sessions.TakeOver(former);
  return sessions;
}

PlanOptions PlanOptionsOf(const Config& config) {
  return {.batch = config.learner.batch,
          .copies = config.replay.copies,
          .target_shifts = config.replay.target_shifts,
          .critic_shifts = config.replay.critic_shifts,
          .horizon = HorizonOf(config),
          .shift_pad = config.replay.shift_pad};
}

}  // namespace

void CheckSampling(const RunConfig& run) {
  const Config& config = run.config;
  // In each environment the newest n steps are not sampleable yet, and the frames of the oldest
  // stack serve one sample only.
  const int64_t envs = int64_t{config.envs_per_actor} * std::max(1, config.actors);
  const int64_t least =
      config.replay.min_size + envs * (SampleStepsOf(config) + int64_t{run.spec.stack});
  if (config.replay.capacity < least) {
    throw UsageError(
        "replay.capacity = {} does not hold replay.min_size = {} samples: with {} environments, "
        "{} and frame stacks of {} expected at least {}",
        config.replay.capacity, config.replay.min_size, envs, SampleStepsText(config),
        run.spec.stack, least);
  }
  OptionsOfLimiter(run);
}

NStep NStepOf(const Config& config) {
  return {.steps = config.replay.n_step, .discount = config.learner.discount};
}

ReplayCore::ReplayCore(const RunConfig& run, const std::filesystem::path& folder,
                       uint64_t replay_session, const FormerServer& former,
                       const StartupProgress& progress)
    : run_(run),
      spec_hash_(run.spec.Hash()),
      replay_session_(replay_session),
      batch_schema_(BatchSchemaOf(run)),
      ring_(run.spec, OptionsOfRing(run.config, folder, former.stored_steps, progress)),
      sessions_(SessionsOf(ring_, former)),
      index_(ring_, IndexOptionsOf(run), progress),
      intake_(spec_hash_, &ring_, &sessions_, &index_),
      policies_(MakePolicies(run, ring_, index_)),
      gather_(ring_, index_, run.spec, NStepOf(run.config), policies_.goals.get(),
              batch_schema_.options().privileged),
      limiter_(OptionsOfLimiter(run)),
      credits_(sessions_, spec_hash_, replay_session, WindowRecords(run), LeastRecords(run)),
      requests_(spec_hash_, batch_schema_.Hash(), run.config.learner.request_credits),
      has_priorities_(HasPriorities(run.config.replay)),
      budget_(static_cast<uint64_t>(run.config.env_steps)) {
  index_.SetSelector(policies_.selector.get());
  limiter_.SetSessions(static_cast<int>(sessions_.newest().size()));
  ring_replaced_ = sessions_.StoresLessThan(former);
}

uint64_t ReplayCore::window_records() const { return WindowRecords(run_); }

void ReplayCore::SetDraining(bool draining) {
  draining_ = draining;
  limiter_.SetDraining(draining);
}

std::optional<uint64_t> ReplayCore::StepsLeft() const {
  if (draining_ || run_.config.lockstep) return std::nullopt;
  return budget_ - std::min(budget_, ring_.stored_steps());
}

ChunkResult ReplayCore::TakeChunk(const TransitionChunk& chunk, uint64_t latest_session) {
  const uint64_t became_before = index_.became_sampleable();
  const ChunkResult result = intake_.Take(chunk, latest_session);
  counters_.intake.Count(result);
  limiter_.SetSessions(static_cast<int>(sessions_.newest().size()));
  limiter_.Inserted(index_.became_sampleable() - became_before, index_.sampleable(),
                    ring_.stored_steps());
  return result;
}

RequestFate ReplayCore::TakeRequest(const SampleRequest& request) {
  const RequestFate fate = requests_.Offer(request);
  if (fate == RequestFate::kWrongSpec || fate == RequestFate::kWrongSchema) {
    ++counters_.refused_requests;
  }
  if (fate == RequestFate::kFull) ++counters_.surplus_requests;
  if (fate == RequestFate::kStale) ++counters_.stale_requests;
  return fate;
}

std::optional<DrawnBatch> ReplayCore::TryAnswer(uint8_t* data) {
  const std::optional<BegunBatch> begun = BeginAnswer(data);
  if (!begun) return std::nullopt;
  for (int part = 0; part < begun->copies.parts(); ++part) begun->copies.MakePart(part);
  return begun->batch;
}

std::optional<BegunBatch> ReplayCore::BeginAnswer(uint8_t* data) {
  const std::optional<SampleRequest> request = requests_.Next(ring_.stored_steps());
  if (!request) return std::nullopt;
  const bool repeated = requests_.Answered(*request);
  // A repeated request was granted when it was answered first.
  if (!repeated && !limiter_.MaySample(index_.sampleable())) return std::nullopt;
  if (!repeated) TakeErrors(*request);
  std::optional<BatchPlan> plan = PlanOf(*request);
  if (!plan) return std::nullopt;
  const BatchView view = batch_schema_.View(data);
  FrameCopies copies = gather_.GatherAllButFrames(*plan, view);
  last_plan_ = *std::move(plan);
  requests_.Pop();
  if (repeated) {
    ++counters_.repeated_batches;
  } else {
    ++counters_.batches;
    counters_.relabelled += static_cast<uint64_t>(
        std::ranges::count_if(last_plan_.elements, [](const auto& e) { return e.goal != 0; }));
    counters_.zero_rewards += static_cast<uint64_t>(std::ranges::count(view.reward, 0.0f));
    limiter_.Sampled();
  }
  return BegunBatch{{*request, ring_.last_id(), ring_.stored_steps(), index_.unsampleable()},
                    std::move(copies)};
}

void ReplayCore::TakeErrors(const SampleRequest& request) {
  for (size_t i = 0; i < request.errors.size(); ++i) {
    const bool set = policies_.selector->SetError(request.error_ids[i], request.errors[i]);
    ++(set ? counters_.priorities_set : counters_.priorities_ignored);
  }
}

std::optional<BatchPlan> ReplayCore::PlanOf(const SampleRequest& request) {
  if (has_priorities_) {
    plans_.OnRequest(request);
    const BatchPlan* drawn = plans_.Find(request.request);
    if (drawn != nullptr && Stored(*drawn)) return *drawn;
  }
  Random random(StreamKey(static_cast<uint64_t>(run_.config.seed), StreamRole::kReplaySampler,
                          request.request));
  std::optional<BatchPlan> plan = DrawPlan(PlanOptionsOf(run_.config), policies_.selector.get(),
                                           policies_.relabeller.get(), &random);
  if (plan && has_priorities_) plans_.Keep(request.request, *plan);
  return plan;
}

bool ReplayCore::Stored(const BatchPlan& plan) const {
  return std::ranges::all_of(plan.elements, [this](const BatchPlan::Element& element) {
    return index_.Sampleable(element.id) && (element.goal == 0 || ring_.Holds(element.goal));
  });
}

std::optional<SampleRequest> ReplayCore::NextRepeated() const {
  const std::optional<SampleRequest> request = requests_.Next(ring_.stored_steps());
  return request && requests_.Answered(*request) ? request : std::nullopt;
}

void ReplayCore::AnsweredAgain() {
  requests_.Pop();
  ++counters_.repeated_batches;
}

std::vector<Credit> ReplayCore::TakeCredits(bool changed_only) {
  credits_.Refresh(limiter_.MayInsert(index_.sampleable()), StepsLeft());
  return credits_.Take(changed_only);
}

bool ReplayCore::CreditsUrgent() {
  credits_.Refresh(limiter_.MayInsert(index_.sampleable()), StepsLeft());
  return credits_.Urgent();
}

Credit ReplayCore::Refusal(const TransitionChunk& chunk) const {
  return shoal::Refusal(chunk, sessions_, spec_hash_, replay_session_);
}

bool ReplayCore::InsertsBlocked() const {
  return !limiter_.MayInsert(index_.sampleable()) && credits_.Withholding();
}

bool ReplayCore::SamplesBlocked() const {
  if (requests_.size() == 0) return false;
  const std::optional<SampleRequest> next = requests_.Next(ring_.stored_steps());
  if (!next) return true;
  return !requests_.Answered(*next) && !limiter_.MaySample(index_.sampleable());
}

}  // namespace shoal::replay
