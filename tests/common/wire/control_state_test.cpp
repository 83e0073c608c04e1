// SPDX-License-Identifier: Apache-2.0
#include "common/wire/control_state.h"

#include <gtest/gtest.h>

namespace shoal {
namespace {

using std::chrono::milliseconds;
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

TEST(ControlState, SettingsOfTheNewestEpochReplaceConfiguredValues) {
  const SteadyTime start = Now();
  ControlState control(start);
  EXPECT_EQ(control.SettingOr("eval.interval", 100), 100);
  EXPECT_FALSE(control.Setting("eval.interval"));
  ControlMessage message = Message(2, RunState::kRunning);
  message.setting_names = {"actors", "eval.interval"};
  message.setting_values = {3, 50};
  control.OnMessage(message, start);
  EXPECT_EQ(control.SettingOr("eval.interval", 100), 50);
  EXPECT_EQ(control.Setting("eval.interval"), 50);
  EXPECT_EQ(control.SettingOr("eval", 100), 100);
  control.OnMessage(Message(1, RunState::kRunning), start);
  EXPECT_EQ(control.SettingOr("eval.interval", 100), 50);
  control.OnMessage(Message(3, RunState::kRunning), start);
  EXPECT_EQ(control.SettingOr("eval.interval", 100), 100);
}

// When a process that looks ten times a second from `from` on takes the coordinator for lost.
SteadyTime LostAt(ControlState* control, SteadyTime from) {
  SteadyTime now = from;
  while (!control->CoordinatorLost(now) && now < from + seconds(100)) now += milliseconds(100);
  return now;
}

TEST(ControlState, TheLeaseRunsFromTheLastHeartbeat) {
  const SteadyTime start = Now();
  ControlState control(start);
  EXPECT_EQ(LostAt(&control, start), start + ControlState::kFirstLease + milliseconds(100));
  const SteadyTime heard = start + seconds(40);
  control.OnMessage(Message(1, RunState::kRunning), heard);
  EXPECT_EQ(LostAt(&control, heard), heard + ControlState::kLease + milliseconds(100));
}

TEST(ControlState, AProcessThatWasStoppedDoesNotTakeTheCoordinatorForLost) {
  const SteadyTime start = Now();
  ControlState control(start);
  control.OnMessage(Message(1, RunState::kRunning), start);
  EXPECT_FALSE(control.CoordinatorLost(start + milliseconds(100)));
  const SteadyTime awake = start + seconds(600);
  EXPECT_FALSE(control.CoordinatorLost(awake)) << "the heartbeats are still unread";
  control.OnMessage(Message(1, RunState::kRunning), awake + milliseconds(10));
  EXPECT_EQ(LostAt(&control, awake + milliseconds(10)),
            awake + milliseconds(110) + ControlState::kLease);
}

}  // namespace
}  // namespace shoal
