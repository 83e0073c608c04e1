// SPDX-License-Identifier: Apache-2.0
// The outermost function of every main: it runs `body`, catches exceptions, maps the result to an
// exit code and prints an Error as one line on stderr.
//
// If a stop signal (stop.h) ended the program in order, the program dies by the same signal: the
// signal's default action is restored and the signal is raised. Shells, make and xargs end a loop
// of commands only if the command died by SIGINT; they treat an exit code of 130 as an ordinary
// failure.
#pragma once

#include <functional>
#include <string>

namespace shoal {

// Returns body()'s value; Error -> "PROGRAM: error: MESSAGE" and its exit code; any other exception
// -> the same line and 1; Interrupted -> "PROGRAM: interrupted: MESSAGE" and kInterruptedExit. If a
// stop signal arrived and the value is 0 or kInterruptedExit, the process ends by the signal.
// Failures keep their exit codes.
int GuardMain(const char* program, const std::function<int()>& body);

// Does the same for a program that runs as threads of another process. The error line is passed to
// `say`; stop signals are left to the process.
int GuardBody(const std::string& program, const std::function<int()>& body,
              const std::function<void(const std::string& line)>& say);

}  // namespace shoal
