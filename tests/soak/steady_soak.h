// SPDX-License-Identifier: Apache-2.0
// A run that is left alone: do memory, open files, threads, queues and files on disk stay as they
// are?
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/soak/fault_soak.h"

namespace shoal::soak {

// Trains for `minutes` after a warm-up of a quarter of it (at least two minutes), looks every five
// seconds. The result lists every figure, and under "broken", a line each, those that grow by more
// than 1 % in ten minutes beyond three standard errors, and logs and metrics above 5 MB an hour.
// Throws Broken (run_under_test.h) when the run itself does not work.
nlohmann::ordered_json SoakSteadily(const SoakOptions& options, double minutes);

}  // namespace shoal::soak
