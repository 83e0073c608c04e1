// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/learner_slots.h"

#include <utility>

#include "common/base/error.h"
#include "common/base/log.h"

namespace shoal::replay {
namespace {

double Megabytes(uint64_t bytes) { return static_cast<double>(bytes) / 1e6; }

}  // namespace

LearnerSlots::LearnerSlots(uint64_t spec_hash, uint64_t batch_bytes, uint32_t slots,
                           std::function<MemoryRoom()> room)
    : spec_hash_(spec_hash), batch_bytes_(batch_bytes), slots_(slots), room_(std::move(room)) {}

bool LearnerSlots::GivesUp(const SampleRequest& request) const {
  if (!writer_) return false;
  return request.learner_session > session_ ||
         (request.learner_session == session_ &&
          request.refused_token == writer_->address().token[0]);
}

void LearnerSlots::OnRequest(const SampleRequest& request) {
  if (request.learner_session < session_) return;
  if (request.learner_session > session_) Begin(request);
  if (!writer_) return;
  if (request.refused_token == writer_->address().token[0]) {
    log::Warning("the learner cannot open the shared memory: batches go over the network");
    writer_.reset();
    return;
  }
  writer_->Release(request.released);
}

// Slots of a former session are never written again, so a learner that still reads one is safe.
void LearnerSlots::Begin(const SampleRequest& request) {
  session_ = request.learner_session;
  writer_.reset();
  if (!request.takes_slots) {
    log::Info("batches go over the network, as the learner asks");
    return;
  }
  try {
    Make();
    log::Info("batches go through shared memory: {} slots, {:.0f} MB", slots_,
              Megabytes(writer_->address().bytes));
  } catch (const Error& e) {
    log::Warning("batches go over the network: {}", e.what());
  }
}

void LearnerSlots::Make() {
  const uint64_t bytes = SlotWriter::MemoryBytes(batch_bytes_, slots_);
  const MemoryRoom room = room_();
  if (bytes > room.bytes) {
    throw RuntimeError("shared memory of {:.0f} MB: {:.0f} MB are available ({})", Megabytes(bytes),
                       Megabytes(room.bytes), room.source);
  }
  writer_.emplace(spec_hash_, session_, batch_bytes_, slots_);
}

}  // namespace shoal::replay
