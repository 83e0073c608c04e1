// SPDX-License-Identifier: Apache-2.0
// Cost of the parts of an update by N replicas, each measured by itself.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace shoal::bench {

// The stages of an update, by the order in which it ends them: of one that moves the actor, and of
// the next one, which does not.
inline constexpr const char* kStageNames[] = {"targets",     "critic forward", "critic backward",
                                              "critic step", "actor forward",  "actor backward",
                                              "actor step",  "targets move"};
inline constexpr size_t kStageOrders[2][8] = {{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 7}};

// Rows, one for each N: an update of one replica alone (LoneReplica) by CPU time, its stages, and
// its primitives alone.
std::vector<nlohmann::ordered_json> ReplicaParts(const std::string& network, int batch,
                                                 const std::vector<int>& replicas, int repetitions);

// A meeting of N threads that arrive at once, in us.
double MeetingMicroseconds(int threads);

// Updates of a batch by each of N threads on its own, beside one thread alone: which part of N
// cores the machine has for N threads that share nothing.
double IndependentShare(const std::string& network, int batch, int threads, double seconds);

}  // namespace shoal::bench
