// SPDX-License-Identifier: Apache-2.0
// The columns of message_list.h as values: name, plane and quality of service of each message.
#pragma once

#include <chrono>
#include <concepts>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/link/message_list.h"
#include "common/link/role.h"
#include "common/wire/messages.h"

namespace shoal::link {

struct TopicSettings {
  const char* name;
  Plane plane;
  // 0: every sample is kept until all readers have it, and a write blocks for at most max_blocking.
  // n: the last n samples per key are kept, older samples are overwritten, and a write never
  // blocks.
  int32_t keep_last;
  bool late_joiners;  // late joiners receive the last keep_last samples per key
  bool bulk;          // true: a @final type in plain CDR; else @appendable (docs/wire_format.md)
  std::chrono::milliseconds max_blocking;
};

template <class M>
struct Topic;

// Values of the words that message_list.h uses.
namespace words {
inline constexpr bool late = true, now = false;
inline constexpr bool bulk = true, small = false;
}  // namespace words

#define SHOAL_TOPIC(message, type, topic, plane, kept, joiners, size, ms, writers, readers)        \
  template <>                                                                                      \
  struct Topic<message> {                                                                          \
    static constexpr TopicSettings kSettings{                                                      \
        topic, Plane::k##plane, kept, words::joiners, words::size, std::chrono::milliseconds(ms)}; \
  };
SHOAL_MESSAGES(SHOAL_TOPIC)
#undef SHOAL_TOPIC

// The roles that may write a topic, and the roles that may read it.
struct TopicRights {
  const char* topic;
  std::vector<Role> writers, readers;
};
std::vector<TopicRights> AllTopicRights();

// A message's key. If keep_last = n > 0, a topic keeps the last n samples of each key of a writer.
using Key = std::pair<std::string, uint64_t>;

template <class M>
Key KeyOf(const M&) {
  return {};
}
inline Key KeyOf(const WeightsPart& part) { return {"", part.part}; }
inline Key KeyOf(const EvalWeightsPart& part) { return {"", part.part}; }
inline Key KeyOf(const ReplayProgress& progress) { return {"", progress.replay}; }
inline Key KeyOf(const CommandMessage& command) { return {"", command.client}; }
inline Key KeyOf(const ReplyMessage& reply) { return {"", reply.client}; }
template <class M>
requires std::derived_from<M, MetricsMessage> Key KeyOf(const M& report) {
  return {report.role, report.id};
}

}  // namespace shoal::link
