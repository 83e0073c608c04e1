// SPDX-License-Identifier: Apache-2.0
// From the plain structs of common/wire to the C structs that idlc generates; the way back is
// bulk_cdr.h and message_cdr.h. Internal.
//
// ToWire borrows: strings and payloads of the result point into the message, so it lives no longer
// than that.
#pragma once

#include <vector>

#include "common/wire/messages.h"
// clang-format off
#include "shoal.h"
// clang-format on

namespace shoal::dds {

// Memory of sequences whose elements are not laid out as the message has them; kept by the
// publisher between calls.
struct WireBuffers {
  std::vector<char*> strings;
  std::vector<shoal_idl_Credit> credits;
  std::vector<shoal_idl_Metrics> processes;
  std::vector<shoal_idl_RunEvent> events;
  std::vector<shoal_idl_EvaluationRequest> evaluations;
};

shoal_idl_TransitionChunk ToWire(const TransitionChunk& message, WireBuffers* buffers);
shoal_idl_BatchPart ToWire(const BatchPart& message, WireBuffers* buffers);
shoal_idl_WeightsPart ToWire(const WeightsPart& message, WireBuffers* buffers);
shoal_idl_Credits ToWire(const CreditsMessage& message, WireBuffers* buffers);
shoal_idl_SampleRequest ToWire(const SampleRequest& message, WireBuffers* buffers);
shoal_idl_BatchSlot ToWire(const BatchSlot& message, WireBuffers* buffers);
shoal_idl_Metrics ToWire(const MetricsMessage& message, WireBuffers* buffers);
shoal_idl_ReplayProgress ToWire(const ReplayProgress& message, WireBuffers* buffers);
shoal_idl_LearnerProgress ToWire(const LearnerProgress& message, WireBuffers* buffers);
shoal_idl_Control ToWire(const ControlMessage& message, WireBuffers* buffers);
shoal_idl_Eval ToWire(const EvalMessage& message, WireBuffers* buffers);
shoal_idl_RunView ToWire(const RunViewMessage& message, WireBuffers* buffers);
shoal_idl_Command ToWire(const CommandMessage& message, WireBuffers* buffers);
shoal_idl_Reply ToWire(const ReplyMessage& message, WireBuffers* buffers);

}  // namespace shoal::dds
