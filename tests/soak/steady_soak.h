// SPDX-License-Identifier: Apache-2.0
// Long test: memory, open files, threads, queues and files on disk of a run without faults must not
// grow.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/soak/fault_soak.h"

namespace shoal::soak {

// Trains for `minutes` after a warm-up of a quarter of this time (at least two minutes) and
// measures every five seconds. The result lists all measured quantities. Its member "broken" has
// one line for each quantity whose growth in ten minutes, less three standard errors, exceeds 1 %,
// and for logs and metrics above 5 MB an hour. Throws Broken (run_under_test.h) if the run itself
// does not work.
nlohmann::ordered_json SoakSteadily(const SoakOptions& options, double minutes);

}  // namespace shoal::soak
