// SPDX-License-Identifier: Apache-2.0
// This host's name, as it calls itself; "unknown" where it does not.
#pragma once

#include <string>

namespace shoal {

std::string HostName();

}  // namespace shoal
