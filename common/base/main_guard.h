// SPDX-License-Identifier: Apache-2.0
// The frame of every main: exceptions end here. Runs `body`, maps its result to an exit code and an
// Error to one line on stderr.
//
// A program that a stop signal (stop.h) ended in order dies by that signal: its default action is
// restored and it is raised. Shells, make and xargs end a loop of commands only if the command died
// by SIGINT; an exit code of 130 is an ordinary failure to them.
#pragma once

#include <functional>
#include <string>

namespace shoal {

// Returns body()'s value; Error -> "PROGRAM: error: MESSAGE" and its exit code; any other exception
// -> the same line and 1; Interrupted -> "PROGRAM: interrupted: MESSAGE" and kInterruptedExit. If a
// stop signal arrived and the value is 0 or kInterruptedExit, the process ends by the signal.
// Failures keep their exit codes.
int GuardMain(const char* program, const std::function<int()>& body);

// The same for a program that runs as threads of another process: the line goes to `say`, and stop
// signals are the process's own.
int GuardBody(const std::string& program, const std::function<int()>& body,
              const std::function<void(const std::string& line)>& say);

}  // namespace shoal
