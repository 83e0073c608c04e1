// SPDX-License-Identifier: Apache-2.0
// Bulk messages: any bytes are either refused or decoded within their bounds, and receivers refuse
// invalid contents. First byte: the kind of message; the rest is serialised CDR.
#include <cstring>

#include "actor/acting/weights_inbox.h"
#include "common/base/check.h"
#include "common/dds/bulk_cdr.h"
#include "learner/batch_assembler.h"
#include "replay_server/core/replay_core.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/replay_server/record_script.h"

namespace shoal {
namespace {

// Cyclone's buffers begin 4 bytes before a multiple of 8 (bulk_cdr.h).
class ReceiveBuffer {
 public:
  explicit ReceiveBuffer(const std::string& bytes)
      : words_(bytes.size() / 8 + 2), size_(bytes.size()) {
    std::memcpy(start(), bytes.data(), size_);
  }
  std::span<const uint8_t> bytes() { return {start(), size_}; }

 private:
  uint8_t* start() { return reinterpret_cast<uint8_t*>(words_.data()) + 4; }
  std::vector<uint64_t> words_;
  size_t size_;
};

template <class M>
void CheckPayloadInside(std::span<const uint8_t> cdr, const M& message) {
  if (message.payload.empty()) return;
  CHECK(message.payload.data() >= cdr.data());
  CHECK(message.payload.data() + message.payload.size() <= cdr.data() + cdr.size());
}

void TakeChunk(std::span<const uint8_t> cdr) {
  TransitionChunk chunk;
  if (!dds::ParseCdr(cdr, &chunk)) return;
  CheckPayloadInside(cdr, chunk);
  const RunConfig run = replay::TinyRun(1, 64);
  replay::ReplayCore core(run, "", 1);
  chunk.spec_hash = run.spec.Hash();
  // A whole number of records, from the first sequence on, so that many inputs get that far.
  const auto record_bytes = static_cast<size_t>(core.ring().layout().record_bytes());
  chunk.count = static_cast<uint32_t>(chunk.payload.size() / record_bytes);
  chunk.payload = chunk.payload.first(chunk.count * record_bytes);
  for (int i = 0; i < 3; ++i) core.TakeChunk(chunk);
  const replay::CoreCounters& counters = core.counters();
  CHECK(core.sessions().TotalStored() == core.ring().last_id());
  CHECK(counters.intake.records == core.ring().last_id());
}

void TakePart(std::span<const uint8_t> cdr) {
  BatchPart part;
  if (!dds::ParseCdr(cdr, &part)) return;
  CheckPayloadInside(cdr, part);
  learner::BatchAssembler assembler(part.spec_hash, part.learner_session, 64, 2);
  CHECK(assembler.Expect(part.request == 0 ? 1 : part.request));
  for (int i = 0; i < 2; ++i) assembler.Add(part);
}

void TakeWeights(std::span<const uint8_t> cdr) {
  WeightsPart weights;
  if (!dds::ParseCdr(cdr, &weights)) return;
  CheckPayloadInside(cdr, weights);
  actor::WeightsInbox inbox(weights.spec_hash);
  inbox.OnMessage(weights);
  inbox.TryTake();
}

}  // namespace
}  // namespace shoal

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  shoal::ReceiveBuffer buffer(shoal::fuzz::Text(data + 1, size - 1));
  if (data[0] % 3 == 0) shoal::TakeChunk(buffer.bytes());
  if (data[0] % 3 == 1) shoal::TakePart(buffer.bytes());
  if (data[0] % 3 == 2) shoal::TakeWeights(buffer.bytes());
  return 0;
}
