// SPDX-License-Identifier: Apache-2.0
// Which domains a run may claim. Internal; the claim itself is ClaimDomain in bus.h.
#pragma once

namespace shoal::dds {

// Whether all fixed ports of a run in the even domain and the odd one above can be had. The
// coordinator's come first and end the search when taken, so that a living run's other processes
// are never disturbed by the question.
bool RunPortsFree(int domain);

}  // namespace shoal::dds
