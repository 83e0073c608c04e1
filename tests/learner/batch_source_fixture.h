// SPDX-License-Identifier: Apache-2.0
// A source of batches with a replay that answers in parts or in slots of shared memory.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

#include "common/config/batch_options.h"
#include "common/wire/batch_slots.h"
#include "learner/batch_source.h"
#include "tests/learner/training_fixture.h"

namespace shoal::learner {

inline constexpr uint64_t kLearnerSession = 5;
inline constexpr std::chrono::milliseconds kLong{20'000};  // never waited for in a test that passes

class BatchSourceTest : public testing::Test {
 protected:
  BatchSource& Make(uint64_t first_request = 1, std::chrono::milliseconds resend_after = kLong) {
    source_.emplace(
        run_, kLearnerSession, first_request,
        [this](const SampleRequest& request) {
          requests_.push_back(request);
          return accepting_;
        },
        resend_after, pin_);
    return *source_;
  }

  // Answers a request in one part; its rewards are the request's number.
  void Answer(uint64_t request, uint64_t stored_steps = 100) {
    const BatchSchema schema = BatchSchemaOf(run_);
    std::vector<uint8_t> space(schema.total_bytes() + 64);
    uint8_t* data = space.data() + (64 - reinterpret_cast<uintptr_t>(space.data()) % 64) % 64;
    for (float& reward : schema.View(data).reward) reward = static_cast<float>(request);
    BatchPart part;
    part.spec_hash = spec_hash_;
    part.learner_session = kLearnerSession;
    part.request = request;
    part.parts = 1;
    part.total_bytes = schema.total_bytes();
    part.stored_records = stored_steps + 2;
    part.stored_steps = stored_steps;
    part.unsampleable_steps = stored_steps / 10;
    part.payload = {data, schema.total_bytes()};
    source_->OnPart(part);
  }

  // Answers a request in a slot of `replay`; its rewards are the request's number.
  BatchSlot AnswerInSlot(SlotWriter& replay, uint64_t request, uint64_t stored_steps = 100) {
    uint8_t* slot = replay.FreeSlot();
    if (slot == nullptr) throw std::runtime_error("no free slot");
    const BatchSchema schema = BatchSchemaOf(run_);
    for (float& reward : schema.View(slot).reward) reward = static_cast<float>(request);
    const BatchSlot word = replay.Fill(request, stored_steps + 2, stored_steps, stored_steps / 10);
    source_->OnSlot(word);
    return word;
  }
  SlotWriter Replay(uint64_t session = kLearnerSession) const {
    return {spec_hash_, session, BatchSchemaOf(run_).total_bytes(), 3};
  }

  std::vector<uint64_t> Asked() const {
    std::vector<uint64_t> ids;
    for (const SampleRequest& request : requests_) ids.push_back(request.request);
    return ids;
  }

  RunConfig run_ = SmallRun();  // two credits
  uint64_t spec_hash_ = run_.spec.Hash();
  PinMemory pin_;
  bool accepting_ = true;
  std::vector<SampleRequest> requests_;
  std::optional<BatchSource> source_;
};

}  // namespace shoal::learner
