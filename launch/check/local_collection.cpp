// SPDX-License-Identifier: Apache-2.0
#include "launch/check/local_collection.h"

#include "actor/acting/environments.h"
#include "common/base/error.h"
#include "common/config/sending_window.h"

namespace shoal::launch {
namespace {

constexpr uint64_t kSession = 1;  // of actor, replay and learner: none of them is restarted

actor::ChunkWindow::Options WindowOptions(const RunConfig& run) {
  const int record_bytes = RecordLayout(run.spec).record_bytes();
  const SendingWindow window = SendingWindowOf(run.config, record_bytes);
  return {.spec_hash = run.spec.Hash(),
          .actor = 0,
          .session = kSession,
          .record_bytes = record_bytes,
          .chunk_records = window.chunk_records,
          .chunks = window.chunks + 1,
          .first_records = static_cast<uint64_t>(window.records())};
}

}  // namespace

LocalCollection::LocalCollection(const RunConfig& run, const std::filesystem::path& folder)
    : run_(run),
      core_(run_, folder, kSession),
      made_(folder, /*actor=*/0, kSession, /*first_env=*/0,
            static_cast<uint32_t>(run_.config.envs_per_actor)),
      window_(WindowOptions(run_)),
      selector_(run_.config, run_.spec, run_.config.envs_per_actor),
      rollout_({.seed = run_.config.seed}, run_.spec,
               actor::MakeEnvironments(run_, run_.config.envs_per_actor), made_, window_,
               selector_),
      batch_(core_.batch_schema().total_bytes()) {}

void LocalCollection::Collect(uint64_t env_steps) {
  const uint64_t until = rollout_.env_steps() + env_steps;
  while (rollout_.env_steps() < until) {
    if (!rollout_.TryStep()) {
      throw RuntimeError("the replay stores nothing more after {} records",
                         core_.counters().intake.records);
    }
    Deliver();
  }
}

// Sends all chunks that the window allows. If the window stays closed, the next TryStep returns
// false.
void LocalCollection::Deliver() {
  window_.Flush();
  for (const Credit& credit : core_.TakeCredits(/*changed_only=*/false)) window_.OnCredit(credit);
  while (const auto chunk = window_.NextToSend()) {
    const ChunkResult result = core_.TakeChunk(*chunk);
    if (result.fate != ChunkFate::kDealtWith || result.stored != chunk->count) {
      throw RuntimeError("the replay stored {} of {} records: {}", result.stored, chunk->count,
                         result.fault == nullptr ? "not taken" : result.fault);
    }
    window_.MarkSent();
    for (const Credit& credit : core_.TakeCredits(/*changed_only=*/true)) window_.OnCredit(credit);
  }
}

BatchView LocalCollection::Draw() {
  core_.TakeRequest({.spec_hash = run_.spec.Hash(),
                     .learner_session = kSession,
                     .request = ++requests_,
                     .batch = static_cast<uint32_t>(run_.config.learner.batch),
                     .after_steps = 0,
                     .schema_hash = core_.batch_schema().Hash()});
  if (!core_.TryAnswer(batch_.data())) {
    throw RuntimeError("the replay gives no batch with {} records",
                       core_.counters().intake.records);
  }
  return core_.batch_schema().View(batch_.data());
}

}  // namespace shoal::launch
