// SPDX-License-Identifier: Apache-2.0
#include "launch/run/control_sender.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/dds/bus.h"
#include "common/link/reader.h"
#include "launch/watch/message_inbox.h"
#include "tests/launch/wait_until.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::SizeIs;

const SteadyTime kStart = SteadyTime() + std::chrono::seconds(1000);

// Uses a separate bus, on which a message arrives before its Write returns.
class ControlSenderTest : public testing::Test {
 protected:
  void SetUp() override {
    const link::Writer<ControlMessage> probe(*bus_);
    ASSERT_TRUE(WaitUntil([&] { return probe.Matched() > 0; }));
  }
  std::vector<ControlMessage> BeatAt(SteadyTime now) {
    sender_.Beat(now);
    return inbox_.TakeAll();
  }

  ClusterAddress address_;
  std::unique_ptr<dds::Bus> bus_ = dds::ClaimDomain(TransportConfig{}, &address_);
  MessageInbox<ControlMessage> inbox_{100};
  link::Reader<ControlMessage> reader_{*bus_,
                                       [this](const ControlMessage& order) { inbox_.Put(order); }};
  LiveSettings settings_{Config{}};
  ControlSender sender_{*bus_, settings_};
};

TEST_F(ControlSenderTest, RepeatsTheOrderAtItsPeriod) {
  EXPECT_THAT(BeatAt(kStart), ElementsAre(Field(&ControlMessage::epoch, 1u)));
  EXPECT_THAT(BeatAt(kStart + milliseconds(299)), SizeIs(0));
  EXPECT_THAT(BeatAt(kStart + ControlSender::kPeriod),
              ElementsAre(Field(&ControlMessage::epoch, 1u)));
}

TEST_F(ControlSenderTest, SendsANewOrderAtOnce) {
  BeatAt(kStart);
  sender_.Order(RunState::kDraining);
  const std::vector<ControlMessage> sent = BeatAt(kStart + milliseconds(1));
  ASSERT_THAT(sent, SizeIs(1));
  EXPECT_EQ(sent[0].epoch, 2u);
  EXPECT_EQ(sent[0].state, RunState::kDraining);
  EXPECT_EQ(sender_.state(), RunState::kDraining);
}

TEST_F(ControlSenderTest, AnOrderHasTheLiveSettings) {
  settings_.Assign("env_steps=4321", 0);
  sender_.Order(settings_);
  const std::vector<ControlMessage> sent = BeatAt(kStart);
  ASSERT_THAT(sent, SizeIs(1));
  EXPECT_THAT(sent[0].setting_names, ElementsAre("env_steps"));
  EXPECT_THAT(sent[0].setting_values, ElementsAre(4321));
}

}  // namespace
}  // namespace shoal::launch
