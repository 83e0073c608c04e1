// SPDX-License-Identifier: Apache-2.0
// The version and commit that this program was built from, and the licence of its sources.
#pragma once

namespace shoal {

// Release number, e.g. "0.1.0".
const char* BuildVersion();
// Git commit of the build. "+" is appended if the checkout had uncommitted changes. "unknown" if
// the sources were not a git checkout.
const char* BuildCommit();
// SPDX identifier.
inline constexpr char kLicence[] = "Apache-2.0";

}  // namespace shoal
