// SPDX-License-Identifier: Apache-2.0
// For each message of the list the type that idlc generates for it. Internal.
#pragma once

#include "common/dds/wire_types.h"
#include "common/link/topic.h"

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

}  // namespace shoal::dds
