// SPDX-License-Identifier: Apache-2.0
// Parts of MJCF that newer versions of MuJoCo added: a model that uses one does not load here, and
// the engine says only that it does not know the word.
#pragma once

#include <string>

namespace shoal::worlds {

// The engine's reason for not loading a model, as one line; where the reason is a word of a newer
// MJCF, with the version that brought it, this engine's version, and what to write instead where
// that is short.
std::string WithNewerMjcf(const std::string& reason);

}  // namespace shoal::worlds
