// SPDX-License-Identifier: Apache-2.0
// Which role writes and reads which topic: what secured runs permit (common/credentials).
#pragma once

#include <vector>

#include "common/credentials/credentials.h"

namespace shoal::dds {

// All roles, by RoleName.
std::vector<RoleRights> AllRoleRights();

}  // namespace shoal::dds
