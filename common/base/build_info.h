// SPDX-License-Identifier: Apache-2.0
// What this program was built from.
#pragma once

namespace shoal {

// Release number, e.g. "0.1.0".
const char* BuildVersion();
// Git commit, with "+" when the tree had changes; "unknown" outside a git checkout.
const char* BuildCommit();

}  // namespace shoal
