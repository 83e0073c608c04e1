// SPDX-License-Identifier: Apache-2.0
// Error messages for parts of MJCF that newer versions of MuJoCo added. A model that uses such a
// part does not load, and the engine reports only an unknown word.
#pragma once

#include <string>

namespace shoal::worlds {

// Returns `reason`, the engine's message about a model that does not load, as one line. If the
// engine does not know a word of a newer MJCF, adds the version that introduced the word, this
// engine's version, and a short replacement if there is one.
std::string WithNewerMjcf(const std::string& reason);

}  // namespace shoal::worlds
