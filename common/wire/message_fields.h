// SPDX-License-Identifier: Apache-2.0
// The fields of each message, listed once, in the order of the wire format (common/dds/shoal.idl).
// Code that writes, reads or prints whole messages uses these lists.
#pragma once

#include <concepts>
#include <tuple>
#include <type_traits>

#include "common/wire/messages.h"

namespace shoal {

// True if M, const or not, is `Message` or derived from it, with the same fields.
template <class M, class Message>
concept FieldsAsIn = std::derived_from<std::remove_const_t<M>, Message>;

// Marks a text that may have several lines, such as JSON. All other texts have only one line,
// because they are shown to users.
template <class S>
struct LongText {
  S& text;
};
template <class S>
LongText(S&) -> LongText<S>;

template <FieldsAsIn<TransitionChunk> M>
auto FieldsOf(M& m) {
  return std::tie(m.actor, m.spec_hash, m.session, m.first_sequence, m.count, m.payload);
}

template <FieldsAsIn<BatchPart> M>
auto FieldsOf(M& m) {
  return std::tie(m.part, m.spec_hash, m.learner_session, m.request, m.offset, m.total_bytes,
                  m.stored_records, m.stored_steps, m.unsampleable_steps, m.parts, m.payload);
}

template <FieldsAsIn<WeightsPart> M>
auto FieldsOf(M& m) {
  return std::tie(m.part, m.spec_hash, m.version.session, m.version.update, m.env_steps,
                  m.total_bytes, m.crc, m.payload, m.checkpoint);
}

template <FieldsAsIn<Credit> M>
auto FieldsOf(M& m) {
  return std::tie(m.actor, m.session, m.replay_session, m.stored, m.allowed, m.spec_hash,
                  m.superseded_by);
}

template <FieldsAsIn<CreditsMessage> M>
auto FieldsOf(M& m) {
  return std::tie(m.credits);
}

template <FieldsAsIn<SampleRequest> M>
auto FieldsOf(M& m) {
  return std::tie(m.spec_hash, m.learner_session, m.request, m.after_steps, m.batch, m.schema_hash,
                  m.released, m.takes_slots, m.refused_token, m.error_ids, m.errors);
}

template <FieldsAsIn<BatchSlot> M>
auto FieldsOf(M& m) {
  return std::tie(m.spec_hash, m.learner_session, m.request, m.stored_records, m.stored_steps,
                  m.unsampleable_steps, m.address.pid, m.address.descriptor, m.address.token[0],
                  m.address.token[1], m.address.bytes, m.slot);
}

template <FieldsAsIn<MetricsMessage> M>
auto FieldsOf(M& m) {
  return std::tie(m.role, m.id, m.host, m.pid, m.state, m.time, m.names, m.values);
}

template <FieldsAsIn<ReplayProgress> M>
auto FieldsOf(M& m) {
  return std::tie(m.replay, m.session, m.stored_steps, m.stored_records);
}

template <FieldsAsIn<EvaluationRequest> M>
auto FieldsOf(M& m) {
  return std::tie(m.update, m.env_steps, m.checkpoint);
}

template <FieldsAsIn<LearnerProgress> M>
auto FieldsOf(M& m) {
  return std::tie(m.session, m.updates, m.env_steps, m.drained, m.evaluations);
}

template <FieldsAsIn<ControlMessage> M>
auto FieldsOf(M& m) {
  return std::tie(m.epoch, m.state, m.time, m.setting_names, m.setting_values);
}

template <FieldsAsIn<EvalMessage> M>
auto FieldsOf(M& m) {
  return std::tuple_cat(std::tie(m.env_steps, m.version.session, m.version.update, m.checkpoint),
                        std::tuple(LongText{m.json}));
}

template <FieldsAsIn<RunEvent> M>
auto FieldsOf(M& m) {
  return std::tie(m.number, m.time, m.text);
}

template <FieldsAsIn<RunViewMessage> M>
auto FieldsOf(M& m) {
  return std::tie(m.schema, m.run, m.time, m.state, m.env_steps, m.updates, m.processes, m.events,
                  m.trouble);
}

template <FieldsAsIn<CommandMessage> M>
auto FieldsOf(M& m) {
  return std::tie(m.client, m.request, m.verb, m.arguments);
}

template <FieldsAsIn<ReplyMessage> M>
auto FieldsOf(M& m) {
  return std::tie(m.client, m.request, m.accepted, m.text, m.key, m.from, m.to);
}

// A message, or a struct that is an element of a message's list.
template <class M>
concept HasFields = requires(M& message) {
  FieldsOf(message);
};

}  // namespace shoal
