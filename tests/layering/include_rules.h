// SPDX-License-Identifier: Apache-2.0
// Rules for includes between folders, checked in the source tree.
//
// - common < actor, replay_server, learner < launch < tests: a folder uses itself and those before
//   it; the three in the middle do not use each other.
// - Inside common, a folder uses those before it in the order of common/CMakeLists.txt; inside the
//   others, a room uses those before it in the order of include_rules.cpp (actor: worlds < acting <
//   sending < ...), to which new rooms are added. Files in the top folder connect its rooms, which
//   do not include them. The tools (launch/tools) follow the rooms of a run, which therefore
//   include none of the tools.
// - replay_server/core knows neither its service nor the transport, no clock and no threads;
//   learner/agent no transport, clock, lock or file, and no threads but those of replicas.
// - The rooms of roles (actor, replay_server, learner) know the link and none of its
//   implementations; their programs do. These rooms, the link and the coordinator's rooms wait,
//   sleep and make threads through common/base alone, so that a simulation can run them.
// - A third-party library with a home (DDS, oneDNN, MuJoCo, ...) is included there and in that
//   folder's tests alone; and in tests/stock_client, a program as others would write it.
// - Headers begin with #pragma once after their comment; no file is called utils, helpers, ...
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal {

// One line per breach: "FILE:LINE: what". `root` is the root of the source tree.
std::vector<std::string> FindBreaches(const std::filesystem::path& root);

// Number of source files found, to distinguish a clean tree from an empty one.
size_t CountSources(const std::filesystem::path& root);

}  // namespace shoal
