// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/engine_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "common/base/error.h"
#include "tests/actor/worlds/engine_warnings.h"

namespace shoal::worlds {
namespace {

TEST(EngineMessages, AnEngineErrorIsThrownWithItsText) {
  InstallEngineCallbacks();
  try {
    mju_error("the table is gone");
    FAIL() << "mju_error returned";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("the table is gone"));
    EXPECT_EQ(error.exit_code(), 1);
  }
}

TEST(EngineMessages, WarningsAreCountedOneByOne) {
  InstallEngineCallbacks();
  ExpectEngineWarnings(5);
  const int64_t before = EngineWarnings();
  for (int i = 0; i < 5; ++i) mju_warning("the floor creaks");
  EXPECT_EQ(EngineWarnings(), before + 5);
}

TEST(EngineMessages, ARepeatedWarningIsLoggedWhenItsCountDoubles) {
  InstallEngineCallbacks();
  ExpectEngineWarnings(8);
  testing::internal::CaptureStderr();
  for (int i = 0; i < 8; ++i) mju_warning("the same again");
  const std::string log = testing::internal::GetCapturedStderr();
  int lines = 0;
  for (size_t at = log.find("the same again"); at != std::string::npos;
       at = log.find("the same again", at + 1)) {
    ++lines;
  }
  EXPECT_EQ(lines, 4) << log;  // 1, 2, 4, 8
}

}  // namespace
}  // namespace shoal::worlds
