// SPDX-License-Identifier: Apache-2.0
// Tells which domains a run may claim. Internal; ClaimDomain in bus.h makes the claim.
#pragma once

namespace shoal::dds {

// Whether all fixed ports of a run are free in the even `domain` and in the odd one above. The
// coordinator's ports are checked first, and the check stops at the first port that is taken. The
// check therefore never binds a port of the other processes of a living run.
bool RunPortsFree(int domain);

}  // namespace shoal::dds
