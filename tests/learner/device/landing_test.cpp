// SPDX-License-Identifier: Apache-2.0
// Order of inputs and commands: a device in host memory runs a lane only when the host waits for it
// or the other lane awaits it.
#include "learner/device/landing.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "learner/device/host_device.h"

namespace shoal::learner::device {
namespace {

class LandingTest : public testing::Test {
 protected:
  // Submits an update that reads one input. The result arrives in *result.
  const float* Submit(float input, float* result) {
    landing_.Begin();
    const float values[] = {input};
    const float* const place = landing_.Add(std::span<const float>(values));
    landing_.Send();
    device_.CopyOut(Lane::kCommands, place, sizeof(float), result);
    landing_.MarkUsed();
    return place;
  }
  // Runs the lane of commands, and of the other lane what the commands await.
  void RunCommands() {
    const auto end = device_.NewEvent();
    device_.Mark(Lane::kCommands, end.get());
    device_.Wait(*end);
  }

  HostDevice device_;
  Landing landing_{&device_};
};

TEST_F(LandingTest, CommandsRunWhenTheirInputsHaveArrived) {
  float result = 0;
  Submit(5, &result);
  RunCommands();
  EXPECT_EQ(result, 5);
}

TEST_F(LandingTest, NewInputsArriveWhenTheCommandsBeforeHaveReadTheOldOnes) {
  float first = 0, second = 0;
  const float* const place = Submit(5, &first);
  EXPECT_EQ(Submit(6, &second), place);
  landing_.Arrive();
  EXPECT_EQ(first, 5);
  RunCommands();
  EXPECT_EQ(second, 6);
}

TEST_F(LandingTest, BorrowedMemoryMayChangeAfterArrive) {
  std::vector<uint8_t> memory = {7};
  landing_.Begin();
  const uint8_t* const place = landing_.Borrow(memory);
  landing_.Send();
  landing_.Arrive();
  memory[0] = 8;
  uint8_t result = 0;
  device_.CopyOut(Lane::kCommands, place, 1, &result);
  RunCommands();
  EXPECT_EQ(result, 7);
}

}  // namespace
}  // namespace shoal::learner::device
