// SPDX-License-Identifier: Apache-2.0
// `shoal check`: tests whether this machine can train.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "launch/check/check_line.h"

namespace shoal::launch {

struct CheckRequest {
  std::filesystem::path run_dir = "runs";  // folder for runs; need not exist
};

// Runs the checks one after another, passes each line to `show` as soon as the line is known, and
// returns all lines. Takes well under a minute. A failed check gives a FAIL line, never an
// exception.
std::vector<CheckLine> CheckMachine(const CheckRequest& request,
                                    const std::function<void(const CheckLine&)>& show);

}  // namespace shoal::launch
