// SPDX-License-Identifier: Apache-2.0
// Checks whether a run may claim a domain. Internal; ClaimDomain in bus.h makes the claim.
#pragma once

namespace shoal::dds {

// Whether all fixed ports of a run are free in the even `domain` and in `domain` + 1. The
// coordinator's ports are checked first, and the check stops at the first port that is taken. If a
// run uses the domain, the check therefore never binds a port of the run's other processes.
bool RunPortsFree(int domain);

}  // namespace shoal::dds
