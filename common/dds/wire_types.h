// Between the plain structs of common/wire and the C structs that idlc generates. Internal.
//
// ToWire borrows: strings and payloads of the result point into the message, so it lives no longer
// than that. FromWire copies, and is false when a message from outside makes no sense; the bulk
// types come in through bulk_cdr.h instead.
#pragma once

#include <vector>

#include "common/wire/messages.h"
// clang-format off
#include "shoal.h"
// clang-format on

namespace shoal::dds {

// Pointer array of a sequence of strings; kept by the publisher between calls.
using StringPointers = std::vector<char*>;

shoal_idl_TransitionChunk ToWire(const TransitionChunk& message, StringPointers* pointers);
shoal_idl_BatchShard ToWire(const BatchShard& message, StringPointers* pointers);
shoal_idl_Weights ToWire(const WeightsMessage& message, StringPointers* pointers);
shoal_idl_Credit ToWire(const Credit& message, StringPointers* pointers);
shoal_idl_SampleRequest ToWire(const SampleRequest& message, StringPointers* pointers);
shoal_idl_Metrics ToWire(const MetricsMessage& message, StringPointers* pointers);
shoal_idl_Control ToWire(const ControlMessage& message, StringPointers* pointers);
shoal_idl_Eval ToWire(const EvalMessage& message, StringPointers* pointers);

bool FromWire(const shoal_idl_Credit& wire, Credit* message);
bool FromWire(const shoal_idl_SampleRequest& wire, SampleRequest* message);
bool FromWire(const shoal_idl_Metrics& wire, MetricsMessage* message);
bool FromWire(const shoal_idl_Control& wire, ControlMessage* message);
bool FromWire(const shoal_idl_Eval& wire, EvalMessage* message);

}  // namespace shoal::dds
