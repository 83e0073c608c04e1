// SPDX-License-Identifier: Apache-2.0
// The topics that each role may write and read in a secured run (common/credentials).
#pragma once

#include <vector>

#include "common/credentials/credentials.h"

namespace shoal::dds {

// The rights of all roles; RoleRights::role is the RoleName.
std::vector<RoleRights> AllRoleRights();

}  // namespace shoal::dds
