// SPDX-License-Identifier: Apache-2.0
// For each message of message_list.h its name, generated type and quality of service. Internal.
#pragma once

#include <chrono>

#include "common/dds/message_list.h"
#include "common/dds/qos.h"
#include "common/dds/wire_types.h"

namespace shoal::dds {

template <class M>
struct Topic;

// The words of the list.
namespace words {
inline constexpr bool late = true, now = false;
inline constexpr bool bulk = true, small = false;
}  // namespace words

#define SHOAL_TOPIC(message, type, topic, plane, kept, joiners, size, ms, writers, readers)        \
  template <>                                                                                      \
  struct Topic<message> {                                                                          \
    using Wire = shoal_idl_##type;                                                                 \
    static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_##type##_desc;               \
    static constexpr TopicSettings kSettings{                                                      \
        topic, Plane::k##plane, kept, words::joiners, words::size, std::chrono::milliseconds(ms)}; \
  };
SHOAL_MESSAGES(SHOAL_TOPIC)
#undef SHOAL_TOPIC

}  // namespace shoal::dds
