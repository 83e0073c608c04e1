// SPDX-License-Identifier: Apache-2.0
// The frame of every main: exceptions end here. Runs `body`, maps its result to an exit code and an
// Error to one line on stderr.
#pragma once

#include <functional>

namespace shoal {

// Returns body()'s value; Error -> "PROGRAM: error: MESSAGE" and its exit code; any other exception
// -> the same line and 1.
int GuardMain(const char* program, const std::function<int()>& body);

}  // namespace shoal
