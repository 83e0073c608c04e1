// SPDX-License-Identifier: Apache-2.0
// A warning of the engine fails the test that causes it: engine_warnings.cpp observes every test of
// this program.
#pragma once

#include <cstdint>

namespace shoal::worlds {

// Expects exactly `count` warnings. For tests that cause warnings on purpose.
void ExpectEngineWarnings(int64_t count);

}  // namespace shoal::worlds
