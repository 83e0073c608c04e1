// SPDX-License-Identifier: Apache-2.0
// Cost of the parts of an update by N replicas. Each part is measured alone.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace shoal::bench {

// The stages of an update in the order in which they end. First row of kStageOrders: an update that
// changes the actor; second row: an update that does not.
inline constexpr const char* kStageNames[] = {"targets",     "critic forward", "critic backward",
                                              "critic step", "actor forward",  "actor backward",
                                              "actor step",  "targets move"};
inline constexpr size_t kStageOrders[2][8] = {{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 7}};

// One row for each N: CPU time of an update of one replica alone (LoneReplica), of the update's
// stages, and of the update's primitives alone.
std::vector<nlohmann::ordered_json> ReplicaParts(const std::string& network, int batch,
                                                 const std::vector<int>& replicas, int repetitions);

// Duration of a barrier of N threads that arrive together, in us.
double MeetingMicroseconds(int threads);

// Rate of N independent threads that each make updates, as a share of N times the rate of one
// thread. The threads share nothing, so this is the part of N cores that the machine provides.
double IndependentShare(const std::string& network, int batch, int threads, double seconds);

}  // namespace shoal::bench
