#include "common/dds/wire_types.h"

#include <cmath>
#include <cstring>

#include "common/dds/bulk_cdr.h"

namespace shoal::dds {
namespace {

// dds_write reads through these pointers only; the generated C structs know no const.
char* Borrow(const std::string& text) { return const_cast<char*>(text.c_str()); }

shoal_idl_Bytes Borrow(std::span<const uint8_t> bytes) {
  const auto size = static_cast<uint32_t>(bytes.size());
  return {size, size, const_cast<uint8_t*>(bytes.data()), false};
}

// A string that an old sender left out reads as a null pointer.
std::string Text(const char* text) { return text == nullptr ? std::string() : std::string(text); }

}  // namespace

shoal_idl_TransitionChunk ToWire(const TransitionChunk& message, StringPointers*) {
  return {kBulkVersion,           message.actor, message.spec_hash,      message.session,
          message.first_sequence, message.count, Borrow(message.payload)};
}

shoal_idl_BatchShard ToWire(const BatchShard& message, StringPointers*) {
  return {kBulkVersion,         message.shard,  message.spec_hash,      message.learner_session,
          message.request,      message.offset, message.total_bytes,    message.stored_records,
          message.stored_steps, message.shards, Borrow(message.payload)};
}

shoal_idl_Weights ToWire(const WeightsMessage& message, StringPointers*) {
  return {
      kBulkVersion,      message.spec_hash, message.version.session, message.version.update,
      message.env_steps, message.crc,       Borrow(message.payload), Borrow(message.checkpoint)};
}

shoal_idl_Credit ToWire(const Credit& message, StringPointers*) {
  return {message.actor,  message.session, message.replay_session,
          message.stored, message.allowed, message.spec_hash};
}

shoal_idl_SampleRequest ToWire(const SampleRequest& message, StringPointers*) {
  return {message.spec_hash, message.learner_session, message.request, message.after_steps,
          message.batch};
}

shoal_idl_Metrics ToWire(const MetricsMessage& message, StringPointers* pointers) {
  pointers->clear();
  for (const std::string& name : message.names) pointers->push_back(Borrow(name));
  const auto names = static_cast<uint32_t>(pointers->size());
  const auto values = static_cast<uint32_t>(message.values.size());
  return {Borrow(message.role),
          message.id,
          Borrow(message.host),
          message.pid,
          Borrow(message.state),
          message.time,
          {names, names, pointers->data(), false},
          {values, values, const_cast<double*>(message.values.data()), false}};
}

shoal_idl_Control ToWire(const ControlMessage& message, StringPointers*) {
  return {message.epoch, static_cast<uint32_t>(message.state), message.time};
}

shoal_idl_Eval ToWire(const EvalMessage& message, StringPointers*) {
  return {message.env_steps, message.version.session, message.version.update,
          Borrow(message.checkpoint), Borrow(message.json)};
}

bool FromWire(const shoal_idl_Credit& wire, Credit* message) {
  *message = {.replay_session = wire.replay_session,
              .actor = wire.actor,
              .session = wire.session,
              .stored = wire.stored,
              .allowed = wire.allowed,
              .spec_hash = wire.spec_hash};
  return wire.replay_session > 0 && wire.session > 0;
}

bool FromWire(const shoal_idl_SampleRequest& wire, SampleRequest* message) {
  *message = {.spec_hash = wire.spec_hash,
              .learner_session = wire.learner_session,
              .request = wire.request,
              .batch = wire.batch,
              .after_steps = wire.after_steps};
  return wire.learner_session > 0 && wire.request > 0 && wire.batch > 0;
}

bool FromWire(const shoal_idl_Metrics& wire, MetricsMessage* message) {
  message->role = Text(wire.role);
  message->id = wire.id;
  message->host = Text(wire.host);
  message->pid = wire.pid;
  message->state = Text(wire.state);
  message->time = wire.time;
  message->names.clear();
  for (uint32_t i = 0; i < wire.names._length; ++i) {
    message->names.push_back(Text(wire.names._buffer[i]));
  }
  message->values.assign(wire.values._buffer, wire.values._buffer + wire.values._length);
  return !message->role.empty() && message->names.size() == message->values.size() &&
         std::isfinite(wire.time);
}

bool FromWire(const shoal_idl_Control& wire, ControlMessage* message) {
  message->epoch = wire.epoch;
  message->state = static_cast<RunState>(wire.state);
  message->time = wire.time;
  const bool known = message->state == RunState::kRunning ||
                     message->state == RunState::kDraining || message->state == RunState::kStopping;
  return known && std::isfinite(wire.time);
}

bool FromWire(const shoal_idl_Eval& wire, EvalMessage* message) {
  message->env_steps = wire.env_steps;
  message->version = {wire.weights_session, wire.weights_update};
  message->checkpoint = Text(wire.checkpoint);
  message->json = Text(wire.json);
  return !message->json.empty();
}

}  // namespace shoal::dds
