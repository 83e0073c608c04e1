// SPDX-License-Identifier: Apache-2.0
// Which folder may include what, read off the source tree.
//
// - common < actor, replay_server, learner < launch < tests: a folder uses itself and those before
//   it; the three in the middle do not use each other.
// - Inside common, a folder uses those before it in the order of common/CMakeLists.txt; inside the
//   others, a room uses those before it in the order of include_rules.cpp (worlds < acting <
//   sending < ... of actor), where a new room gets its place. Files of the top folder itself put
//   its rooms together and are used by none of them. The tools (launch/tools) come after the
//   rooms of a run, which therefore include none of them.
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

// Source files seen, to tell a clean tree from an empty one.
size_t CountSources(const std::filesystem::path& root);

}  // namespace shoal
