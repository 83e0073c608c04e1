// SPDX-License-Identifier: Apache-2.0
// The message of an error, for tests that expect errors.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "common/base/error.h"

namespace shoal {

// The message of the Error that `act` throws; empty if `act` throws no Error.
template <class Act>
std::string ErrorMessage(Act act) {
  try {
    act();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

// The same message. Also expects that the Error has this exit code, for example 2 for wrong usage.
template <class Act>
std::string ErrorMessage(int exit_code, Act act) {
  try {
    act();
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), exit_code) << e.what();
    return e.what();
  }
  return "";
}
template <class Act>
std::string UsageMessage(Act act) {
  return ErrorMessage(2, act);
}

}  // namespace shoal
