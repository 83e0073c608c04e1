// SPDX-License-Identifier: Apache-2.0
#include "learner/device/host_copies.h"

#include <gtest/gtest.h>

#include <deque>
#include <memory>

#include "learner/device/host_device.h"

namespace shoal::learner::device {
namespace {

class HostCopiesTest : public testing::Test {
 protected:
  ~HostCopiesTest() override { device_.Free(value_); }

  void Set(float value) {
    inputs_.push_back(value);
    device_.CopyIn(Lane::kCommands, &inputs_.back(), sizeof(float), value_);
  }
  std::shared_ptr<const HostCopies::Copy> Begin() { return copies_.Begin(value_, sizeof(float)); }
  static float Wait(const HostCopies::Copy& copy) {
    return *static_cast<const float*>(copy.Wait());
  }

  HostDevice device_;
  HostCopies copies_{&device_};
  std::deque<float> inputs_;
  float* const value_ = static_cast<float*>(device_.Allocate(sizeof(float)));
};

TEST_F(HostCopiesTest, ACopyHasTheValuesOfItsPlaceInTheOrderOfCommands) {
  Set(1);
  const auto first = Begin();
  Set(2);
  const auto second = Begin();
  Set(3);
  EXPECT_EQ(device_.waiting(), 7u) << "nothing has run: three inputs, two copies and their marks";
  EXPECT_EQ(Wait(*second), 2);
  EXPECT_EQ(Wait(*first), 1);
  EXPECT_EQ(Wait(*first), 1) << "as often as one likes";
}

TEST_F(HostCopiesTest, HostMemoryIsUsedAgain) {
  for (const float value : {1.f, 2.f, 3.f}) {
    Set(value);
    EXPECT_EQ(Wait(*Begin()), value);
  }
  EXPECT_EQ(copies_.memories(), 1u);
  const auto first = Begin(), second = Begin();
  EXPECT_EQ(copies_.memories(), 2u) << "the first is on its way";
}

// Each copy takes the smallest memory in which it fits, so that the larger one stays free.
TEST_F(HostCopiesTest, ASmallCopyLeavesLargeMemoryToLargeCopies) {
  auto* const large = static_cast<float*>(device_.Allocate(2 * sizeof(float)));
  for (int i = 0; i < 2; ++i) {
    const auto a = copies_.Begin(large, 2 * sizeof(float)), b = Begin();
  }
  for (int i = 0; i < 2; ++i) {
    const auto b = Begin(), a = copies_.Begin(large, 2 * sizeof(float));
  }
  EXPECT_EQ(copies_.memories(), 2u);
  device_.Free(large);
}

// The device still writes the first copy when the second one gets its memory.
TEST_F(HostCopiesTest, ACopyThatWasNotReadDoesNotSpoilTheNextOne) {
  Set(1);
  Begin();
  Set(2);
  const auto copy = Begin();
  EXPECT_EQ(copies_.memories(), 1u);
  EXPECT_EQ(Wait(*copy), 2);
}

}  // namespace
}  // namespace shoal::learner::device
