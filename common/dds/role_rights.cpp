// SPDX-License-Identifier: Apache-2.0
#include "common/dds/role_rights.h"

#include <algorithm>

#include "common/link/topic.h"

namespace shoal::dds {

std::vector<RoleRights> AllRoleRights() {
  std::vector<RoleRights> all;
  for (const link::Role role : link::kRoles) {
    RoleRights rights{.role = link::RoleName(role), .publishes = {}, .subscribes = {}};
    for (const link::TopicRights& topic : link::AllTopicRights()) {
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
