// SPDX-License-Identifier: Apache-2.0
// Rules for includes between folders, checked in the source tree.
//
// - Order of folders: common < actor, replay_server, learner < launch < tests. A folder uses itself
//   and earlier folders. actor, replay_server and learner do not use each other.
// - Inside common, a folder uses earlier folders in the order of common/CMakeLists.txt. Inside the
//   other folders, a room (subfolder) uses earlier rooms in the order of include_rules.cpp (actor:
//   worlds < acting < sending < ...); add new rooms to this order. Files in the top folder connect
//   its rooms, and the rooms do not include these files. The tools (launch/tools) come after the
//   rooms of a run, so these rooms include none of the tools.
// - replay_server/core uses neither its service nor the transport, clocks or threads.
//   learner/agent uses no transport, clock, lock or file, and only the threads of replicas.
// - The rooms of roles (actor, replay_server, learner) use the link, but no implementation of the
//   link; the programs of the roles use the implementations. These rooms, the link and the
//   coordinator's rooms wait, sleep and make threads only through common/base, so that a simulation
//   can run them.
// - If a third-party library belongs to a folder (DDS, oneDNN, MuJoCo, ...), only this folder, its
//   tests and tests/stock_client include the library. tests/stock_client is an example of a program
//   by other authors.
// - Headers begin with #pragma once after their comment; no file is called utils, helpers, ...
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal {

// One line per breach of a rule: "FILE:LINE: what". `root` is the root of the source tree.
std::vector<std::string> FindBreaches(const std::filesystem::path& root);

// Number of source files found, to distinguish a clean tree from an empty one.
size_t CountSources(const std::filesystem::path& root);

}  // namespace shoal
