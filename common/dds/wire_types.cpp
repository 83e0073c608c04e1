// SPDX-License-Identifier: Apache-2.0
#include "common/dds/wire_types.h"

#include "common/base/check.h"
#include "common/dds/bulk_cdr.h"

namespace shoal::dds {
namespace {

// dds_write reads through these pointers only; the generated C structs know no const.
char* Borrow(const std::string& text) { return const_cast<char*>(text.c_str()); }

shoal_idl_Bytes Borrow(std::span<const uint8_t> bytes) {
  const auto size = static_cast<uint32_t>(bytes.size());
  return {size, size, const_cast<uint8_t*>(bytes.data()), false};
}

shoal_idl_Doubles Borrow(const std::vector<double>& values) {
  const auto size = static_cast<uint32_t>(values.size());
  return {size, size, const_cast<double*>(values.data()), false};
}

// Appends pointers to the strings to `pointers`, which has room for them and must not move.
shoal_idl_Strings Borrow(const std::vector<std::string>& strings, std::vector<char*>* pointers) {
  CHECK(pointers->capacity() - pointers->size() >= strings.size());
  char** first = pointers->data() + pointers->size();
  for (const std::string& text : strings) pointers->push_back(Borrow(text));
  const auto size = static_cast<uint32_t>(strings.size());
  return {size, size, first, false};
}

shoal_idl_Metrics MetricsToWire(const MetricsMessage& message, std::vector<char*>* pointers) {
  return {Borrow(message.role),
          message.id,
          Borrow(message.host),
          message.pid,
          Borrow(message.state),
          message.time,
          Borrow(message.names, pointers),
          Borrow(message.values)};
}

}  // namespace

shoal_idl_TransitionChunk ToWire(const TransitionChunk& message, WireBuffers*) {
  return {kBulkVersion,           message.actor, message.spec_hash,      message.session,
          message.first_sequence, message.count, Borrow(message.payload)};
}

shoal_idl_BatchPart ToWire(const BatchPart& message, WireBuffers*) {
  return {kBatchPartVersion,          message.part,           message.spec_hash,
          message.learner_session,    message.request,        message.offset,
          message.total_bytes,        message.stored_records, message.stored_steps,
          message.unsampleable_steps, message.parts,          Borrow(message.payload)};
}

shoal_idl_WeightsPart ToWire(const WeightsPart& message, WireBuffers*) {
  return {kWeightsVersion,         message.part,
          message.spec_hash,       message.version.session,
          message.version.update,  message.env_steps,
          message.total_bytes,     message.crc,
          Borrow(message.payload), Borrow(message.checkpoint)};
}

shoal_idl_Credits ToWire(const CreditsMessage& message, WireBuffers* buffers) {
  buffers->credits.clear();
  for (const Credit& credit : message.credits) {
    buffers->credits.push_back({credit.actor, credit.session, credit.replay_session, credit.stored,
                                credit.allowed, credit.spec_hash, credit.superseded_by});
  }
  const auto size = static_cast<uint32_t>(buffers->credits.size());
  return {{size, size, buffers->credits.data(), false}};
}

shoal_idl_SampleRequest ToWire(const SampleRequest& message, WireBuffers*) {
  return {message.spec_hash,   message.learner_session, message.request,
          message.after_steps, message.batch,           message.schema_hash,
          message.released,    message.takes_slots,     message.refused_token};
}

shoal_idl_BatchSlot ToWire(const BatchSlot& message, WireBuffers*) {
  const SlotAddress& address = message.address;
  return {message.spec_hash,    message.learner_session,    message.request, message.stored_records,
          message.stored_steps, message.unsampleable_steps, address.pid,     address.descriptor,
          address.token[0],     address.token[1],           address.bytes,   message.slot};
}

shoal_idl_Metrics ToWire(const MetricsMessage& message, WireBuffers* buffers) {
  buffers->strings.clear();
  buffers->strings.reserve(message.names.size());
  return MetricsToWire(message, &buffers->strings);
}

shoal_idl_ReplayProgress ToWire(const ReplayProgress& message, WireBuffers*) {
  return {message.replay, message.session, message.stored_steps, message.stored_records};
}

shoal_idl_LearnerProgress ToWire(const LearnerProgress& message, WireBuffers* buffers) {
  buffers->evaluations.clear();
  for (const EvaluationRequest& evaluation : message.evaluations) {
    buffers->evaluations.push_back(
        {evaluation.update, evaluation.env_steps, Borrow(evaluation.checkpoint)});
  }
  const auto size = static_cast<uint32_t>(buffers->evaluations.size());
  return {message.session,
          message.updates,
          message.env_steps,
          message.drained,
          {size, size, buffers->evaluations.data(), false}};
}

shoal_idl_Control ToWire(const ControlMessage& message, WireBuffers* buffers) {
  buffers->strings.clear();
  buffers->strings.reserve(message.setting_names.size());
  return {message.epoch, static_cast<uint32_t>(message.state), message.time,
          Borrow(message.setting_names, &buffers->strings), Borrow(message.setting_values)};
}

shoal_idl_Eval ToWire(const EvalMessage& message, WireBuffers*) {
  return {message.env_steps, message.version.session, message.version.update,
          Borrow(message.checkpoint), Borrow(message.json)};
}

shoal_idl_RunView ToWire(const RunViewMessage& message, WireBuffers* buffers) {
  size_t strings = 0;
  for (const MetricsMessage& process : message.processes) strings += process.names.size();
  buffers->strings.clear();
  buffers->strings.reserve(strings);
  buffers->processes.clear();
  for (const MetricsMessage& process : message.processes) {
    buffers->processes.push_back(MetricsToWire(process, &buffers->strings));
  }
  buffers->events.clear();
  for (const RunEvent& event : message.events) {
    buffers->events.push_back({event.number, event.time, Borrow(event.text)});
  }
  const auto processes = static_cast<uint32_t>(buffers->processes.size());
  const auto events = static_cast<uint32_t>(buffers->events.size());
  return {Borrow(message.schema),
          Borrow(message.run),
          message.time,
          Borrow(message.state),
          message.env_steps,
          message.updates,
          {processes, processes, buffers->processes.data(), false},
          {events, events, buffers->events.data(), false},
          Borrow(message.trouble)};
}

shoal_idl_Command ToWire(const CommandMessage& message, WireBuffers* buffers) {
  buffers->strings.clear();
  buffers->strings.reserve(message.arguments.size());
  return {message.client, message.request, Borrow(message.verb),
          Borrow(message.arguments, &buffers->strings)};
}

shoal_idl_Reply ToWire(const ReplyMessage& message, WireBuffers*) {
  return {message.client,      message.request, message.accepted, Borrow(message.text),
          Borrow(message.key), message.from,    message.to};
}

}  // namespace shoal::dds
