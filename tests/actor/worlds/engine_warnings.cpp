// SPDX-License-Identifier: Apache-2.0
#include "tests/actor/worlds/engine_warnings.h"

#include <gtest/gtest.h>

#include "actor/worlds/engine_messages.h"

namespace shoal::worlds {
namespace {

int64_t expected_warnings = 0;

class WarningListener : public testing::EmptyTestEventListener {
 public:
  void OnTestProgramStart(const testing::UnitTest&) override { InstallEngineCallbacks(); }
  void OnTestStart(const testing::TestInfo&) override {
    before_ = EngineWarnings();
    expected_warnings = 0;
  }
  void OnTestEnd(const testing::TestInfo&) override {
    EXPECT_EQ(EngineWarnings() - before_, expected_warnings)
        << "warnings of the engine, see the log";
  }

 private:
  int64_t before_ = 0;
};

// Before main(), which is GoogleTest's. The list of listeners owns it.
[[maybe_unused]] const bool listening = [] {
  testing::UnitTest::GetInstance()->listeners().Append(new WarningListener);
  return true;
}();

}  // namespace

void ExpectEngineWarnings(int64_t count) { expected_warnings = count; }

}  // namespace shoal::worlds
