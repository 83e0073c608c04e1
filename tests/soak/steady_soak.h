// SPDX-License-Identifier: Apache-2.0
// Checks that memory, open files, threads, queues and files on disk of an undisturbed run do not
// grow.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/soak/fault_soak.h"

namespace shoal::soak {

// Trains for `minutes` after a warm-up of a quarter of that time (at least two minutes) and samples
// every five seconds. The result lists every figure. Its member "broken" has one line for each
// figure that grows by more than 1 % in ten minutes beyond three standard errors, and for logs and
// metrics above 5 MB an hour. Throws Broken (run_under_test.h) if the run itself does not work.
nlohmann::ordered_json SoakSteadily(const SoakOptions& options, double minutes);

}  // namespace shoal::soak
