// SPDX-License-Identifier: Apache-2.0
#include "learner/device/card/gpu_refusal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shoal::learner::device {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// CUDA 13.0 in the library and in the driver, no GPU.
GpuFindings NoGpu() {
  return {.error = "no CUDA-capable device is detected",
          .runtime_version = 13000,
          .driver_version = 13000,
          .gpus = 0,
          .visible = nullptr,
          .slurm_gpus = nullptr,
          .in_slurm = false};
}

GpuProperties Gpu() {
  return {.name = "GPU X",
          .major = 9,
          .minor = 0,
          .free_bytes = int64_t{70} << 30,
          .memory_bytes = int64_t{80} << 30};
}

TEST(GpuRefusal, AVisibleGpuIsNotRefused) {
  GpuFindings found = NoGpu();
  found.error = "";
  found.gpus = 2;
  found.visible = "0,1";
  EXPECT_EQ(WhyNoGpu(found), "");
  EXPECT_EQ(WhyNotThisGpu(Gpu()), "");
}

TEST(GpuRefusal, NamesAMissingDriver) {
  GpuFindings found = NoGpu();
  found.driver_version = 0;
  EXPECT_EQ(WhyNoGpu(found), "this host has no NVIDIA driver (no libcuda.so.1)");
}

TEST(GpuRefusal, NamesTheVersionsOfADriverThatIsTooOld) {
  GpuFindings found = NoGpu();
  found.driver_version = 12040;
  EXPECT_EQ(WhyNoGpu(found),
            "the NVIDIA driver is too old: it supports CUDA 12.4, expected at least 13.0");
  found.driver_version = 13010;  // newer
  EXPECT_THAT(WhyNoGpu(found), HasSubstr("no NVIDIA GPU"));
}

TEST(GpuRefusal, NamesTheVariableThatHidesEveryGpu) {
  GpuFindings found = NoGpu();
  found.visible = "";
  EXPECT_EQ(WhyNoGpu(found), "CUDA_VISIBLE_DEVICES = '' hides every GPU from this process");
}

TEST(GpuRefusal, NamesTheOptionOfSlurmThatWasForgotten) {
  GpuFindings found = NoGpu();
  found.in_slurm = true;
  EXPECT_THAT(WhyNoGpu(found), HasSubstr("--gres=gpu:1"));
  found.slurm_gpus = "0";  // given, and yet not usable
  EXPECT_THAT(WhyNoGpu(found), HasSubstr("no CUDA-capable device is detected"));
}

TEST(GpuRefusal, NamesAGpuThatIsTooOldOrFull) {
  GpuProperties gpu = Gpu();
  gpu.major = 7;
  gpu.minor = 5;
  EXPECT_THAT(WhyNotThisGpu(gpu), AllOf(HasSubstr("GPU X"), HasSubstr("7.5"), HasSubstr("8.0")));
  gpu = Gpu();
  gpu.free_bytes = int64_t{100} << 20;
  EXPECT_THAT(WhyNotThisGpu(gpu), AllOf(HasSubstr("GPU X has 100 of 81920 MB"), HasSubstr("512")));
  gpu.free_bytes = -1;
  EXPECT_EQ(WhyNotThisGpu(gpu), "") << "the free memory is not known yet";
}

}  // namespace
}  // namespace shoal::learner::device
