// SPDX-License-Identifier: Apache-2.0
#include "learner/pin_memory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "learner/device/host_device.h"

namespace shoal::learner {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class PinMemoryTest : public testing::Test {
 protected:
  // HostDevice CHECKs that no memory is registered twice, and at its end that none is registered.
  device::HostDevice device_;
  std::vector<uint8_t> memory_ = std::vector<uint8_t>(100);
};

TEST_F(PinMemoryTest, MemoryIsRegisteredUntilThePinEnds) {
  const PinMemory pin = PinOn(&device_);
  std::shared_ptr<const void> pinned = pin(memory_);
  ASSERT_NE(pinned, nullptr);
  EXPECT_DEATH(pin(memory_), "already registered");
  pinned.reset();
  EXPECT_NE(pin(memory_), nullptr) << "it was unregistered";
}

TEST_F(PinMemoryTest, ADeviceThatCannotPinIsNamedOnce) {
  device::HostDevice unable({.registers = false});
  const PinMemory pin = PinOn(&unable), copy = pin;
  testing::internal::CaptureStderr();
  EXPECT_EQ(pin(memory_), nullptr);
  const std::string first = testing::internal::GetCapturedStderr();
  EXPECT_THAT(first, HasSubstr("host memory cannot pin the memory of batches"));
  testing::internal::CaptureStderr();
  EXPECT_EQ(pin(memory_), nullptr);
  EXPECT_EQ(copy(memory_), nullptr);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), Not(HasSubstr("pin")));
}

}  // namespace
}  // namespace shoal::learner
