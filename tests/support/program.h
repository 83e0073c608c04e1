// SPDX-License-Identifier: Apache-2.0
// Runs one of the built programs to its end and reads its output.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/base/files.h"
#include "launch/processes/child_process.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal {

struct ProgramResult {
  bool ended = false;  // false: killed at the deadline
  launch::ExitStatus status;
  std::string out, err;
};

// Runs a command. command[0] is a path; `environment` is added to the test's environment.
inline ProgramResult RunCommand(std::vector<std::string> command, std::chrono::seconds deadline,
                                std::vector<std::pair<std::string, std::string>> environment = {}) {
  const TemporaryFolder folder;
  launch::ProcessSpec spec;
  spec.role = "test";
  spec.command = std::move(command);
  spec.environment = std::move(environment);
  spec.output = folder.path() / "out";
  spec.errors = folder.path() / "err";
  const auto status = launch::RunToEnd(spec, deadline, [] { return false; });
  ProgramResult result;
  result.ended = status.has_value();
  if (status) result.status = *status;
  result.out = ReadFile(spec.output);
  result.err = ReadFile(spec.errors);
  return result;
}

// Runs a program. command[0] is the program's name in the build's bin folder.
inline ProgramResult RunProgram(std::vector<std::string> command, std::chrono::seconds deadline) {
  command[0] = ProgramPath(command[0]);
  return RunCommand(std::move(command), deadline);
}

// Exit code, or -1 if the program was killed or did not end.
inline int ExitCode(const ProgramResult& result) {
  return result.ended && !result.status.by_signal ? result.status.code : -1;
}

}  // namespace shoal
