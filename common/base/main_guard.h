// SPDX-License-Identifier: Apache-2.0
// The outermost function of every main: it runs `body`, catches exceptions, maps the result to an
// exit code and prints an Error as one line on stderr.
//
// If a stop signal (stop.h) ended the program in order, the process ends by the same signal:
// GuardMain restores the signal's default action and raises the signal. Shells, make and xargs stop
// a series of commands only if a command was killed by SIGINT. They treat an exit code of 130 as an
// ordinary failure.
#pragma once

#include <functional>
#include <string>

namespace shoal {

// Returns the value of body(). If body() throws, prints a line and returns an exit code:
//
//   Error            "PROGRAM: error: MESSAGE"         its exit code
//   Interrupted      "PROGRAM: interrupted: MESSAGE"   kInterruptedExit
//   other exception  "PROGRAM: error: MESSAGE"         1
//
// If a stop signal arrived and the returned value would be 0 or kInterruptedExit, the process ends
// by the signal instead. Other exit codes are returned unchanged.
int GuardMain(const char* program, const std::function<int()>& body);

// Does the same for a program that runs as threads of another process, except that the line is
// passed to `say` and that stop signals do not end the process here.
int GuardBody(const std::string& program, const std::function<int()>& body,
              const std::function<void(const std::string& line)>& say);

}  // namespace shoal
