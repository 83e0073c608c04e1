// SPDX-License-Identifier: Apache-2.0
// `shoal check`: can this machine train?
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "launch/check/check_line.h"

namespace shoal::launch {

struct CheckRequest {
  std::filesystem::path run_dir = "runs";  // where runs will lie; need not be there
};

// Looks at one thing after another and hands each line over as soon as it is known; also returns
// them all. Takes well under a minute. A failed look is a FAIL line, never an exception.
std::vector<CheckLine> CheckMachine(const CheckRequest& request,
                                    const std::function<void(const CheckLine&)>& show);

}  // namespace shoal::launch
