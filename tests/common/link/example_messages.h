// SPDX-License-Identifier: Apache-2.0
// Example messages with number n, equal in every process, for tests that compare sent and received
// messages. Every field has its own value, which depends on n.
#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/random.h"
#include "common/wire/messages.h"

namespace shoal {

// `payload_bytes` pseudo-random bytes that depend on n.
inline std::vector<uint8_t> ExamplePayload(uint64_t n, size_t payload_bytes) {
  std::vector<uint8_t> payload(payload_bytes);
  Random random(n);
  for (uint8_t& byte : payload) byte = static_cast<uint8_t>(random.Next());
  return payload;
}

inline void Fill(uint64_t n, TransitionChunk* m) {
  *m = {.spec_hash = n + 1000,
        .actor = 3,
        .count = 1,
        .session = 4,
        .first_sequence = n,
        .payload = m->payload};
}
inline void Fill(uint64_t n, Credit* m) {
  *m = {.replay_session = 5,
        .actor = 3,
        .session = 4,
        .stored = n,
        .allowed = n + 100,
        .spec_hash = n + 1000,
        .superseded_by = n + 18};
}
inline void Fill(uint64_t n, CreditsMessage* m) {
  m->credits.resize(2);
  Fill(n, &m->credits[0]);
  Fill(n + 1, &m->credits[1]);
}
inline void Fill(uint64_t n, SampleRequest* m) {
  *m = {.spec_hash = n + 1000,
        .learner_session = 6,
        .request = n,
        .batch = 128,
        .after_steps = n + 7,
        .schema_hash = n + 8,
        .released = n - 1,
        .takes_slots = true,
        .refused_token = n + 22,
        .error_ids = {n + 24, n + 25},
        .errors = {0.5f, static_cast<float>(n)}};
}
inline void Fill(uint64_t n, BatchSlot* m) {
  *m = {.spec_hash = n + 1000,
        .learner_session = 6,
        .request = n,
        .stored_records = n + 8,
        .stored_steps = n + 9,
        .unsampleable_steps = n + 23,
        .address = {.pid = 12, .descriptor = 13, .token = {n + 19, n + 20}, .bytes = n + 21},
        .slot = 14};
}
inline void Fill(uint64_t n, BatchPart* m) {
  *m = {.spec_hash = n + 1000,
        .learner_session = 6,
        .request = n,
        .part = 2,
        .parts = 9,
        .offset = n * 64,
        .total_bytes = n * 64 + m->payload.size() + 1,
        .stored_records = n + 8,
        .stored_steps = n + 9,
        .unsampleable_steps = n + 23,
        .payload = m->payload};
}
inline void Fill(uint64_t n, WeightsPart* m) {
  m->part = 4;
  m->spec_hash = n + 1000;
  m->version = {6, n};
  m->total_bytes = m->payload.size() + n;
  m->env_steps = n + 10;
  m->crc = static_cast<uint32_t>(n + 11);
  m->checkpoint = fmt::format("step_{}", n);
}
inline void Fill(uint64_t n, MetricsMessage* m) {
  *m = {.role = "actor",
        .id = 3,
        .host = "host-ü",
        .pid = -12,
        .state = "running",
        .time = static_cast<double>(n),
        .names = {"a/b", "", "c"},
        .values = {0.1, -1e300, static_cast<double>(n)}};
}
inline void Fill(uint64_t n, ReplayProgress* m) {
  *m = {.replay = 2, .session = 5, .stored_steps = n, .stored_records = n + 14};
}
inline void Fill(uint64_t n, LearnerProgress* m) {
  *m = {.session = 6,
        .updates = n,
        .env_steps = n + 15,
        .drained = true,
        .evaluations = {{.update = n - 1, .env_steps = n + 16, .checkpoint = "step-ü"},
                        {.update = n, .env_steps = n + 17, .checkpoint = ""}}};
}
inline void Fill(uint64_t n, ControlMessage* m) {
  *m = {.epoch = n,
        .state = RunState::kDraining,
        .time = static_cast<double>(n) + 0.5,
        .setting_names = {"eval.interval", "b"},
        .setting_values = {static_cast<double>(n), 0.25}};
}
inline void Fill(uint64_t n, EvalMessage* m) {
  *m = {.env_steps = n + 12,
        .version = {6, n},
        .checkpoint = "best",
        .json = fmt::format("{{\"n\": {}}}", n)};
}

inline void Fill(uint64_t n, RunViewMessage* m) {
  m->run = "run-ü";
  m->time = static_cast<double>(n) + 0.25;
  m->state = "evaluating";
  m->env_steps = n + 13;
  m->updates = n;
  m->processes.resize(3);
  for (uint64_t i = 0; i < m->processes.size(); ++i) Fill(n + i, &m->processes[i]);
  m->processes[1].names.clear();  // no two processes report the same metrics
  m->processes[1].values.clear();
  m->events = {{.number = n, .time = 1.5, .text = "first"},
               {.number = n + 1, .time = 2, .text = ""}};
  m->trouble = "actors 1 of 2";
}
inline void Fill(uint64_t n, CommandMessage* m) {
  *m = {.client = 7, .request = n, .verb = "set", .arguments = {"eval.interval=5", ""}};
}
inline void Fill(uint64_t n, ReplyMessage* m) {
  *m = {.client = 7,
        .request = n,
        .accepted = true,
        .text = "done",
        .key = "eval.interval",
        .from = static_cast<double>(n),
        .to = -0.5};
}

// The number n of a message, to count missing messages.
inline uint64_t Number(const TransitionChunk& m) { return m.first_sequence; }
inline uint64_t Number(const CreditsMessage& m) { return m.credits.at(0).stored; }
inline uint64_t Number(const SampleRequest& m) { return m.request; }
inline uint64_t Number(const BatchSlot& m) { return m.request; }
inline uint64_t Number(const BatchPart& m) { return m.request; }
inline uint64_t Number(const WeightsPart& m) { return m.version.update; }
inline uint64_t Number(const MetricsMessage& m) { return static_cast<uint64_t>(m.time); }
inline uint64_t Number(const ReplayProgress& m) { return m.stored_steps; }
inline uint64_t Number(const LearnerProgress& m) { return m.updates; }
inline uint64_t Number(const ControlMessage& m) { return m.epoch; }
inline uint64_t Number(const EvalMessage& m) { return m.version.update; }
inline uint64_t Number(const RunViewMessage& m) { return m.updates; }
inline uint64_t Number(const CommandMessage& m) { return m.request; }
inline uint64_t Number(const ReplyMessage& m) { return m.request; }

// Builds message n and calls use(message). The payload is valid during the call.
template <class M, class Use>
void WithExample(uint64_t n, const std::vector<uint8_t>& payload, const Use& use) {
  M message;
  if constexpr (requires { message.payload; }) message.payload = payload;
  Fill(n, &message);
  use(message);
}

}  // namespace shoal
