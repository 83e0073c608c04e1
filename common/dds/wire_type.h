// SPDX-License-Identifier: Apache-2.0
// Maps each message of message_list.h, and each struct within a message, to the C type that idlc
// generates. Internal.
#pragma once

#include "common/link/topic.h"
#include "common/wire/messages.h"
// clang-format off
#include "shoal.h"
// clang-format on

namespace shoal::dds {

template <class M>
struct WireType;

#define SHOAL_WIRE_TYPE(message, type, ...)                                                \
  template <>                                                                              \
  struct WireType<message> {                                                               \
    using Wire = shoal_idl_##type;                                                         \
    static constexpr const dds_topic_descriptor_t* kDescriptor = &shoal_idl_##type##_desc; \
  };
SHOAL_MESSAGES(SHOAL_WIRE_TYPE)
#undef SHOAL_WIRE_TYPE

template <>
struct WireType<Credit> {
  using Wire = shoal_idl_Credit;
};
template <>
struct WireType<EvaluationRequest> {
  using Wire = shoal_idl_EvaluationRequest;
};
template <>
struct WireType<MetricsMessage> {
  using Wire = shoal_idl_Metrics;
};
template <>
struct WireType<RunEvent> {
  using Wire = shoal_idl_RunEvent;
};

}  // namespace shoal::dds
