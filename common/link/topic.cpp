// SPDX-License-Identifier: Apache-2.0
#include "common/link/topic.h"

namespace shoal::link {

using enum Role;

#define SHOAL_ROLES(...) \
  { __VA_ARGS__ }
#define SHOAL_RIGHTS(message, type, topic, plane, kept, joiners, size, ms, writers, readers) \
  {topic, SHOAL_ROLES writers, SHOAL_ROLES readers},
std::vector<TopicRights> AllTopicRights() { return {SHOAL_MESSAGES(SHOAL_RIGHTS)}; }
#undef SHOAL_RIGHTS
#undef SHOAL_ROLES

}  // namespace shoal::link
