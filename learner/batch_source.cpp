// SPDX-License-Identifier: Apache-2.0
#include "learner/batch_source.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/config/lockstep.h"
#include "common/config/priorities.h"

namespace shoal::learner {
namespace {

// Delay before a request that could not be sent is tried again.
constexpr std::chrono::milliseconds kRetryAfter{100};
constexpr std::chrono::seconds kRefusalInterval{10};  // between log lines about refusals

uint64_t LastRequest(const Config& config) {
  return config.lockstep ? LockstepLastUpdate(config) : std::numeric_limits<uint64_t>::max();
}

}  // namespace

BatchSource::BatchSource(const RunConfig& run, uint64_t learner_session, uint64_t first_request,
                         Send send, std::chrono::milliseconds resend_after, PinMemory pin)
    : run_(run),
      spec_hash_(run.spec.Hash()),
      learner_session_(learner_session),
      last_request_(LastRequest(run.config)),
      schema_(BatchSchemaOf(run)),
      has_priorities_(HasPriorities(run.config.replay)),
      send_(std::move(send)),
      resend_after_(resend_after),
      pin_(std::move(pin)),
      assembler_(spec_hash_, learner_session, schema_.total_bytes(),
                 run.config.learner.request_credits + 1),
      slots_(learner_session, schema_.total_bytes(), pin_),
      next_request_(first_request) {
  CHECK(first_request > 0);
}

void BatchSource::OnPart(const BatchPart& part) {
  using Verdict = BatchAssembler::Verdict;
  const MutexLock lock(mutex_);
  if (slots_.Has(part.request)) {
    ++counters_.duplicate_parts;
    return;
  }
  const Verdict verdict = assembler_.Add(part);
  switch (verdict) {
    case Verdict::kStartedOver:
      ++counters_.dropped_answers;
      [[fallthrough]];
    case Verdict::kTaken:
    case Verdict::kCompleted:
      break;
    case Verdict::kDuplicate:
      ++counters_.duplicate_parts;
      return;
    case Verdict::kUnknownRequest:
    case Verdict::kStaleSession:
      ++counters_.unknown_parts;
      return;
    case Verdict::kMalformed:
      ++counters_.malformed_parts;
      return;
    case Verdict::kWrongSpec:
      other_spec_hash_ = part.spec_hash;
      arrived_.NotifyOne();
      return;
  }
  // A part delays the repetition of the request; a complete batch needs none.
  if (Outstanding* outstanding = Find(part.request)) {
    outstanding->next_send =
        verdict == Verdict::kCompleted ? SteadyTime::max() : Now() + resend_after_;
  }
  arrived_.NotifyOne();
}

void BatchSource::OnSlot(const BatchSlot& slot) {
  using Verdict = SlotBatches::Verdict;
  const MutexLock lock(mutex_);
  if (slot.spec_hash != spec_hash_) {
    other_spec_hash_ = slot.spec_hash;
    arrived_.NotifyOne();
    return;
  }
  Outstanding* outstanding = Find(slot.request);
  if (slot.learner_session != learner_session_ || outstanding == nullptr) {
    ++counters_.unknown_parts;
    return;
  }
  if (assembler_.TryGet(slot.request)) {
    ++counters_.duplicate_parts;
    return;
  }
  switch (slots_.Add(slot)) {
    case Verdict::kStartedOver:
      ++counters_.dropped_answers;
      [[fallthrough]];
    case Verdict::kTaken:
      outstanding->next_send = SteadyTime::max();
      arrived_.NotifyOne();
      return;
    case Verdict::kDuplicate:
      ++counters_.duplicate_parts;
      return;
    case Verdict::kRefused:
      ++counters_.refused_slots;
      return;
  }
}

std::optional<Batch> BatchSource::Next(SteadyTime deadline) {
  {
    const MutexLock lock(mutex_);
    ReleaseHandedOut();
  }
  std::optional<Batch> batch;
  while (!batch) {
    SendDue();
    const MutexLock lock(mutex_);
    RefuseOtherSpec();
    batch = TakeFirst();
    if (batch) break;
    if (Now() >= deadline) return std::nullopt;
    arrived_.WaitUntil(mutex_, std::min(deadline, NextDue()));
  }
  SendDue();  // the replay draws the next batches while this one is used
  return batch;
}

BatchCounters BatchSource::counters() const {
  const MutexLock lock(mutex_);
  BatchCounters counters = counters_;
  counters.requests_outstanding = outstanding_.size();
  counters.shared = shared_;
  counters.ready = static_cast<uint64_t>(
      std::ranges::count(outstanding_, SteadyTime::max(), &Outstanding::next_send));
  return counters;
}

void BatchSource::TakeErrors(const SampleErrors& errors) {
  const MutexLock lock(mutex_);
  CHECK(errors_.empty() || errors_.back().request < errors.request) << errors.request;
  errors_.push_back(errors);
}

SampleErrors BatchSource::ErrorsFor(uint64_t request) {
  const uint64_t delay = static_cast<uint64_t>(run_.config.learner.request_credits) + kErrorDelay;
  if (errors_.empty() || errors_.front().request + delay > request) return {};
  SampleErrors errors = std::move(errors_.front());
  errors_.pop_front();
  return errors;
}

SampleRequest BatchSource::MakeRequest(const Outstanding& outstanding) const {
  const Config& config = run_.config;
  const uint64_t request = outstanding.request;
  return {.spec_hash = spec_hash_,
          .learner_session = learner_session_,
          .request = request,
          .batch = static_cast<uint32_t>(config.learner.batch),
          .after_steps = config.lockstep ? LockstepStepsBeforeUpdate(config, request) : 0,
          .schema_hash = schema_.Hash(),
          .released = released_,
          .takes_slots = true,
          .refused_token = slots_.refused_token(),
          .error_ids = outstanding.errors.ids,
          .errors = outstanding.errors.errors};
}

BatchSource::Outstanding* BatchSource::Find(uint64_t request) {
  const auto found = std::ranges::find(outstanding_, request, &Outstanding::request);
  return found == outstanding_.end() ? nullptr : &*found;
}

bool BatchSource::Whole(uint64_t request) {
  return slots_.Has(request) || assembler_.TryGet(request).has_value();
}

void BatchSource::ReleaseHandedOut() {
  if (handed_out_ == 0) return;
  released_ = std::exchange(handed_out_, 0);
  assembler_.Release(released_);
  slots_.Release(released_);
}

void BatchSource::Extend() {
  const auto credits = static_cast<size_t>(run_.config.learner.request_credits);
  while (outstanding_.size() < credits && next_request_ <= last_request_) {
    CHECK(assembler_.Expect(next_request_)) << "one buffer per credit and one for the caller";
    outstanding_.push_back({.request = next_request_, .errors = ErrorsFor(next_request_)});
    ++next_request_;
  }
}

void BatchSource::SendDue() {
  std::vector<SampleRequest> due;
  {
    const MutexLock lock(mutex_);
    Extend();
    due = TakeDue();
  }
  std::vector<uint64_t> unsent;
  for (const SampleRequest& request : due) {
    if (!send_(request)) unsent.push_back(request.request);
  }
  if (unsent.empty()) return;
  const MutexLock lock(mutex_);
  TryAgain(unsent);
}

std::vector<SampleRequest> BatchSource::TakeDue() {
  const SteadyTime now = Now();
  std::vector<SampleRequest> due;
  for (Outstanding& o : outstanding_) {
    if (o.next_send > now) continue;
    due.push_back(MakeRequest(o));
    o.next_send = now + resend_after_;
    if (!std::exchange(o.sent, true)) continue;
    ++counters_.resent_requests;
    // A restarted replay has lost the priorities. Its answer may have other samples, although the
    // ring is the same.
    if (has_priorities_) assembler_.StartOver(o.request);
  }
  return due;
}

void BatchSource::TryAgain(const std::vector<uint64_t>& unsent) {
  for (Outstanding& o : outstanding_) {
    // An earlier copy of the request may have been answered meanwhile.
    if (!std::ranges::count(unsent, o.request) || Whole(o.request)) continue;
    o.sent = false;
    o.next_send = Now() + kRetryAfter;
  }
}

SteadyTime BatchSource::NextDue() const {
  SteadyTime next = SteadyTime::max();
  for (const Outstanding& o : outstanding_) next = std::min(next, o.next_send);
  return next;
}

std::optional<Batch> BatchSource::TakeFirst() {
  if (outstanding_.empty()) return std::nullopt;
  const std::optional<Batch> batch = FindBatch(outstanding_.front().request);
  if (!batch) return std::nullopt;
  SayWay(slots_.Has(batch->request));
  outstanding_.pop_front();
  handed_out_ = batch->request;
  return batch;
}

std::optional<Batch> BatchSource::FindBatch(uint64_t request) {
  if (slots_.Has(request)) return OpenSlot(request);
  const auto assembled = assembler_.TryGet(request);
  if (!assembled) return std::nullopt;
  Pin(assembled->data);
  return Batch{.view = schema_.View(assembled->data, assembled->stored_steps),
               .request = request,
               .stored_records = assembled->stored_records,
               .unsampleable_steps = assembled->unsampleable_steps};
}

std::optional<Batch> BatchSource::OpenSlot(uint64_t request) {
  try {
    return Batch{.view = schema_.View(slots_.Open(request), slots_.stored_steps(request)),
                 .request = request,
                 .stored_records = slots_.stored_records(request),
                 .unsampleable_steps = slots_.unsampleable_steps(request)};
  } catch (const Error& e) {
    SayRefusal(e.what());
    for (const uint64_t refused : slots_.Refuse(request)) {
      ++counters_.refused_slots;
      if (Outstanding* outstanding = Find(refused)) outstanding->next_send = Now();
    }
    return std::nullopt;
  }
}

// The memory of assembled batches is used again, as long as this object lives.
void BatchSource::Pin(const uint8_t* assembled) {
  if (!pin_ || pinned_.contains(assembled)) return;
  pinned_[assembled] = pin_({assembled, schema_.total_bytes()});
}

// Logs at most one line in kRefusalInterval.
void BatchSource::SayRefusal(const char* why) {
  if (refusal_said_ && Now() - *refusal_said_ < kRefusalInterval) return;
  refusal_said_ = Now();
  log::Warning("{}; asking for batches over the network", why);
}

void BatchSource::SayWay(bool shared) {
  if (shared_ == shared) return;
  shared_ = shared;
  log::Info("batches come {}", shared ? "through shared memory" : "over the network");
}

void BatchSource::RefuseOtherSpec() const {
  if (other_spec_hash_ == 0) return;
  throw RuntimeError(
      "the replay sends batches of observation spec {:016x}; this run's is {:016x} [{}]",
      other_spec_hash_, spec_hash_, run_.spec.Summary());
}

}  // namespace shoal::learner
