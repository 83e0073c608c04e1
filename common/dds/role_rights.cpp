// SPDX-License-Identifier: Apache-2.0
#include "common/dds/role_rights.h"

#include <algorithm>
#include <initializer_list>

#include "common/dds/domain_xml.h"
#include "common/dds/message_list.h"

namespace shoal::dds {
namespace {

using enum Role;

struct TopicRights {
  const char* topic;
  std::vector<Role> writers, readers;
};

#define SHOAL_ROLES(...) \
  { __VA_ARGS__ }
#define SHOAL_RIGHTS(message, type, topic, plane, kept, joiners, size, ms, writers, readers) \
  {topic, SHOAL_ROLES writers, SHOAL_ROLES readers},
std::vector<TopicRights> AllTopicRights() { return {SHOAL_MESSAGES(SHOAL_RIGHTS)}; }
#undef SHOAL_RIGHTS
#undef SHOAL_ROLES

}  // namespace

std::vector<RoleRights> AllRoleRights() {
  std::vector<RoleRights> all;
  for (const Role role : {kCoordinator, kLearner, kReplay, kActor, kEval, kClient}) {
    RoleRights rights{.role = RoleName(role), .publishes = {}, .subscribes = {}};
    for (const TopicRights& topic : AllTopicRights()) {
      if (std::ranges::find(topic.writers, role) != topic.writers.end()) {
        rights.publishes.emplace_back(topic.topic);
      }
      if (std::ranges::find(topic.readers, role) != topic.readers.end()) {
        rights.subscribes.emplace_back(topic.topic);
      }
    }
    all.push_back(std::move(rights));
  }
  return all;
}

}  // namespace shoal::dds
