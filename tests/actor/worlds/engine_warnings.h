// SPDX-License-Identifier: Apache-2.0
// A warning of the engine fails the test in which it comes: engine_warnings.cpp listens to every
// test of this program.
#pragma once

#include <cstdint>

namespace shoal::worlds {

// For a test that brings them about: so many of them are to come, no more and no fewer.
void ExpectEngineWarnings(int64_t count);

}  // namespace shoal::worlds
