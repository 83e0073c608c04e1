// SPDX-License-Identifier: Apache-2.0
// Supervisor of shell scripts. Restarts have delays of milliseconds.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/files.h"
#include "launch/processes/supervisor.h"
#include "tests/launch/wait_until.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {

inline constexpr RestartLimits kQuick{.restarts = 3,
                                      .window = std::chrono::seconds(60),
                                      .first_delay = std::chrono::milliseconds(1),
                                      .longest_delay = std::chrono::milliseconds(4)};

class SupervisorTest : public ::testing::Test {
 protected:
  ProcessSpec Fake(const std::string& role, int id, const std::string& script) const {
    ProcessSpec spec;
    spec.role = role;
    spec.id = id;
    spec.command = {"/bin/sh", "-c", "echo started; " + script};
    spec.output = folder_.path() / (spec.Name() + ".log");
    return spec;
  }
  int Starts(const std::string& name) const {
    const auto file = folder_.path() / (name + ".log");
    if (!std::filesystem::exists(file)) return 0;
    const std::string text = ReadFile(file);
    int starts = 0;
    for (size_t at = text.find("started\n"); at != std::string::npos;
         at = text.find("started\n", at + 1)) {
      ++starts;
    }
    return starts;
  }
  // Polls until the run fails. Returns the reason.
  std::string WaitForFailure() {
    std::optional<std::string> failure;
    EXPECT_TRUE(WaitUntil([&] { return (failure = supervisor_.Poll(Now())).has_value(); }));
    return failure.value_or("");
  }
  bool PollUntil(const std::function<bool()>& condition) {
    return WaitUntil([&] {
      EXPECT_EQ(supervisor_.Poll(Now()), std::nullopt);
      return condition();
    });
  }

  TemporaryFolder folder_;
  std::vector<std::string> said_;
  Supervisor supervisor_{kQuick, HangLimits(),
                         [this](const std::string& line) { said_.push_back(line); }};
};

}  // namespace shoal::launch
