// SPDX-License-Identifier: Apache-2.0
#include "actor/sending/chunk_sender.h"

#include <algorithm>

#include "common/wire/scoped_seconds.h"

namespace shoal::actor {

SupersededError::SupersededError(uint32_t actor, uint64_t session)
    : Error(RuntimeError(
          "another process is actor {} with the later session {}: was this number started twice?",
          actor, session)),
      session_(session) {}

ChunkSender::ChunkSender(ChunkWindow& window, ChunkLink& link, const Options& options)
    : window_(window),
      link_(link),
      options_(options),
      last_flush_(options.now()),
      last_progress_(last_flush_),
      last_heard_(last_flush_) {}

void ChunkSender::Exchange(SteadyTime deadline) {
  Hear(deadline);
  const SteadyTime now = options_.now();
  if (now - last_flush_ >= options_.flush_after) {
    window_.Flush();
    last_flush_ = now;
  }
  // Without a sent record that awaits its acknowledgement, there is no progress to wait for.
  if (!window_.HasUnstoredSent()) last_progress_ = now;
  if (now - std::min(last_progress_, last_heard_) > kResendAfter) {
    window_.Rewind();
    last_progress_ = last_heard_ = now;
  }
  Send();
}

void ChunkSender::Hear(SteadyTime deadline) {
  const auto credit = link_.TakeCredit(deadline);
  if (!credit) return;
  last_heard_ = options_.now();
  if (credit->spec_hash != options_.spec_hash) {
    throw RuntimeError("the replay's observation spec {:016x} is not this actor's {:016x} [{}]",
                       credit->spec_hash, options_.spec_hash, options_.spec_summary);
  }
  if (credit->superseded_by > credit->session) {
    throw SupersededError(credit->actor, credit->superseded_by);
  }
  const uint64_t stored_before = window_.stored();
  window_.OnCredit(*credit);
  if (window_.stored() > stored_before) last_progress_ = options_.now();
}

void ChunkSender::Send() {
  const ScopedSeconds timed(publish_seconds_);
  while (link_.Connected()) {
    const auto chunk = window_.NextToSend();
    if (!chunk) break;
    if (!link_.Send(*chunk)) {
      ++write_timeouts_;
      break;
    }
    window_.MarkSent();
  }
}

}  // namespace shoal::actor
