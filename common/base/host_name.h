// SPDX-License-Identifier: Apache-2.0
// The name of this host; "unknown" if the system gives none.
#pragma once

#include <string>

namespace shoal {

std::string HostName();

}  // namespace shoal
