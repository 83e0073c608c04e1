#include "common/wire/control_state.h"

#include <gtest/gtest.h>

namespace shoal {
namespace {

using std::chrono::seconds;

ControlMessage Message(uint64_t epoch, RunState state) {
  ControlMessage message;
  message.epoch = epoch;
  message.state = state;
  return message;
}

TEST(ControlState, TheNewestEpochHolds) {
  const SteadyTime start = Now();
  ControlState control(start);
  EXPECT_EQ(control.state(), RunState::kRunning);
  control.OnMessage(Message(2, RunState::kDraining), start);
  control.OnMessage(Message(1, RunState::kRunning), start);
  EXPECT_EQ(control.state(), RunState::kDraining);
  control.OnMessage(Message(3, RunState::kStopping), start);
  EXPECT_EQ(control.state(), RunState::kStopping);
}

TEST(ControlState, TheLeaseRunsFromTheLastHeartbeat) {
  const SteadyTime start = Now();
  ControlState control(start);
  EXPECT_FALSE(control.CoordinatorLost(start + ControlState::kFirstLease));
  EXPECT_TRUE(control.CoordinatorLost(start + ControlState::kFirstLease + seconds(1)));
  const SteadyTime heard = start + seconds(5);
  control.OnMessage(Message(1, RunState::kRunning), heard);
  EXPECT_FALSE(control.CoordinatorLost(heard + ControlState::kLease));
  EXPECT_TRUE(control.CoordinatorLost(heard + ControlState::kLease + seconds(1)));
}

}  // namespace
}  // namespace shoal
