// SPDX-License-Identifier: Apache-2.0
// A replay core with a tiny spec, one actor's records for it, and requests of a learner.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "common/base/aligned_bytes.h"
#include "common/config/batch_options.h"
#include "replay_server/core/replay_core.h"
#include "tests/replay_server/record_script.h"
#include "tests/support/temporary_folder.h"

namespace shoal::replay {

class ReplayCoreTest : public testing::Test {
 protected:
  ReplayCoreTest() : run_(TinyRun(2, 64)) { run_.config.replay.shift_pad = 1; }

  void Start() { core_.emplace(run_, folder_.path(), ++replay_session_); }
  ChunkResult Store(RecordScript* script, uint64_t first, uint32_t count) {
    return core_->TakeChunk(script->Chunk(first, count));
  }
  RequestFate Ask(uint64_t request, uint64_t after_steps = 0, uint64_t session = 1) {
    return core_->TakeRequest({.spec_hash = run_.spec.Hash(),
                               .learner_session = session,
                               .request = request,
                               .batch = static_cast<uint32_t>(run_.config.learner.batch),
                               .after_steps = after_steps,
                               .schema_hash = BatchSchemaOf(run_).Hash()});
  }
  // The next batch's bytes; empty when nothing is answered.
  std::vector<uint8_t> Answer() {
    const uint64_t bytes = core_->batch_schema().total_bytes();
    const AlignedBytes memory(bytes);
    std::memset(memory.data(), 0, bytes);
    drawn_ = core_->TryAnswer(memory.data());
    if (!drawn_) return {};
    return {memory.data(), memory.data() + bytes};
  }

  RunConfig run_;
  TemporaryFolder folder_;
  std::optional<ReplayCore> core_;
  std::optional<DrawnBatch> drawn_;
  uint64_t replay_session_ = 0;
  RecordScript actor_{TinySpec(2), 0, 10};
};

}  // namespace shoal::replay
