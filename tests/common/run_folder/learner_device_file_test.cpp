// SPDX-License-Identifier: Apache-2.0
#include "common/run_folder/learner_device_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using ::testing::HasSubstr;

TEST(LearnerDeviceFile, ReadsWhatWasWritten) {
  const TemporaryFolder run;
  EXPECT_EQ(ReadLearnerDevice(run.path()), std::nullopt);
  const LearnerDeviceRecord on_gpu{.device = "cuda",
                                   .card = "GPU X",
                                   .driver = "580.1",
                                   .memory_bytes = 85'000'000'000,
                                   .precision = "bf16",
                                   .losses = 1};
  WriteLearnerDevice(run.path(), on_gpu);
  EXPECT_EQ(ReadLearnerDevice(run.path()), on_gpu);
  const LearnerDeviceRecord on_cpu{.precision = "f32", .reason = "no driver", .losses = 2};
  WriteLearnerDevice(run.path(), on_cpu);
  EXPECT_EQ(ReadLearnerDevice(run.path()), on_cpu);
}

TEST(LearnerDeviceFile, NamesTheProcessorInOneLine) {
  EXPECT_EQ(
      Describe(
          {.device = "cuda", .card = "GPU X", .driver = "580.1", .memory_bytes = 85'000'000'000}),
      "GPU X (85 GB, driver 580.1)");
  EXPECT_EQ(Describe({.reason = "no driver"}), "the CPU: no driver");
  EXPECT_EQ(Describe({}), "the CPU");
}

TEST(LearnerDeviceFile, ADamagedFileIsRefusedByName) {
  const TemporaryFolder run;
  WriteFileAtomically(run.path() / "learner_device.json",
                      R"({"schema": "shoal-learner-device-1", "device": 3})");
  EXPECT_THAT(ErrorMessage([&] { ReadLearnerDevice(run.path()); }),
              HasSubstr("learner_device.json': 'device': expected a text"));
}

}  // namespace
}  // namespace shoal
