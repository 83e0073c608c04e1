// SPDX-License-Identifier: Apache-2.0
// Messages as text with every field, for tests that compare what was sent with what arrived.
#pragma once

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <span>
#include <string>

#include "common/base/random.h"
#include "common/wire/messages.h"

namespace shoal {

// Size and hash.
inline std::string Bytes(std::span<const uint8_t> payload) {
  return fmt::format("{}:{:x}", payload.size(), HashBytes(payload.data(), payload.size()));
}

// One line; payloads as size and hash.
inline std::string Describe(const TransitionChunk& m) {
  return fmt::format("{} {} {} {} {} {}", m.spec_hash, m.actor, m.count, m.session,
                     m.first_sequence, Bytes(m.payload));
}
inline std::string Describe(const Credit& m) {
  return fmt::format("{} {} {} {} {} {} {}", m.replay_session, m.actor, m.session, m.stored,
                     m.allowed, m.spec_hash, m.superseded_by);
}
inline std::string Describe(const CreditsMessage& m) {
  std::string all;
  for (const Credit& credit : m.credits) all += Describe(credit) + "; ";
  return all;
}
inline std::string Describe(const SampleRequest& m) {
  return fmt::format("{} {} {} {} {} {} {} {} {}", m.spec_hash, m.learner_session, m.request,
                     m.batch, m.after_steps, m.schema_hash, m.released, m.takes_slots,
                     m.refused_token);
}
inline std::string Describe(const BatchSlot& m) {
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}", m.spec_hash, m.learner_session,
                     m.request, m.stored_records, m.stored_steps, m.unsampleable_steps,
                     m.address.pid, m.address.descriptor, m.address.token[0], m.address.token[1],
                     m.address.bytes, m.slot);
}
inline std::string Describe(const BatchPart& m) {
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {}", m.spec_hash, m.learner_session, m.request,
                     m.part, m.parts, m.offset, m.total_bytes, m.stored_records, m.stored_steps,
                     m.unsampleable_steps, Bytes(m.payload));
}
inline std::string Describe(const WeightsPart& m) {
  return fmt::format("{} {} {} {} {} {} {} {} {}", m.part, m.spec_hash, m.version.session,
                     m.version.update, m.env_steps, m.total_bytes, m.crc, m.checkpoint,
                     Bytes(m.payload));
}
inline std::string Describe(const MetricsMessage& m) {
  return fmt::format("{} {} {} {} {} {} [{}] [{}]", m.role, m.id, m.host, m.pid, m.state, m.time,
                     fmt::join(m.names, ","), fmt::join(m.values, ","));
}
inline std::string Describe(const ReplayProgress& m) {
  return fmt::format("{} {} {} {}", m.replay, m.session, m.stored_steps, m.stored_records);
}
inline std::string Describe(const LearnerProgress& m) {
  std::string text = fmt::format("{} {} {} {}", m.session, m.updates, m.env_steps, m.drained);
  for (const EvaluationRequest& e : m.evaluations) {
    text += fmt::format(" ({} {} {})", e.update, e.env_steps, e.checkpoint);
  }
  return text;
}
inline std::string Describe(const ControlMessage& m) {
  return fmt::format("{} {} {} [{}] [{}]", m.epoch, static_cast<uint32_t>(m.state), m.time,
                     fmt::join(m.setting_names, ","), fmt::join(m.setting_values, ","));
}
inline std::string Describe(const EvalMessage& m) {
  return fmt::format("{} {} {} {} {}", m.env_steps, m.version.session, m.version.update,
                     m.checkpoint, m.json);
}

inline std::string Describe(const RunViewMessage& m) {
  std::string text =
      fmt::format("{} {} {} {} {} {}", m.schema, m.run, m.time, m.state, m.env_steps, m.updates);
  for (const MetricsMessage& process : m.processes) text += " (" + Describe(process) + ")";
  for (const RunEvent& e : m.events) text += fmt::format(" ({} {} {})", e.number, e.time, e.text);
  text += " " + m.trouble;
  return text;
}
inline std::string Describe(const CommandMessage& m) {
  return fmt::format("{} {} {} [{}]", m.client, m.request, m.verb, fmt::join(m.arguments, ","));
}
inline std::string Describe(const ReplyMessage& m) {
  return fmt::format("{} {} {} {} {} {} {}", m.client, m.request, m.accepted, m.text, m.key, m.from,
                     m.to);
}

}  // namespace shoal
