// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/weights_inbox.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>

namespace shoal::actor {
namespace {

constexpr uint64_t kInboxSpec = 5;

void Deliver(WeightsInbox& inbox, uint64_t session, uint64_t update, const std::string& payload,
             uint64_t spec = kInboxSpec, uint32_t crc_error = 0) {
  WeightsMessage weights;
  weights.spec_hash = spec;
  weights.version = {session, update};
  weights.payload = {reinterpret_cast<const uint8_t*>(payload.data()), payload.size()};
  for (uint32_t part = 0; part < WeightsParts(payload.size()); ++part) {
    WeightsPart message = PartOf<WeightsPart>(weights, part);
    message.crc ^= crc_error;
    inbox.OnMessage(message);
  }
}

TEST(WeightsInbox, KeepsOnlyTheNewest) {
  WeightsInbox inbox(kInboxSpec);
  EXPECT_FALSE(inbox.TryTake());
  Deliver(inbox, 1, 10, "a");
  Deliver(inbox, 1, 30, "c");
  Deliver(inbox, 1, 20, "b");
  const auto weights = inbox.TryTake();
  ASSERT_TRUE(weights);
  EXPECT_EQ(weights->version.update, 30u);
  EXPECT_EQ(weights->payload.view(), "c");
  EXPECT_FALSE(inbox.TryTake());
}

TEST(WeightsInbox, ANewerLearnerSessionWinsWhateverItsUpdate) {
  WeightsInbox inbox(kInboxSpec);
  Deliver(inbox, 1, 500, "old");
  ASSERT_TRUE(inbox.TryTake());
  Deliver(inbox, 2, 400, "restored");
  EXPECT_EQ(inbox.TryTake()->payload.view(), "restored");
  Deliver(inbox, 1, 501, "ghost");
  EXPECT_FALSE(inbox.TryTake());
}

TEST(WeightsInbox, RefusesForeignAndDamagedWeights) {
  WeightsInbox inbox(kInboxSpec);
  Deliver(inbox, 1, 1, "x", kInboxSpec + 1);
  Deliver(inbox, 1, 1, "x", kInboxSpec, /*crc_error=*/1);
  EXPECT_FALSE(inbox.TryTake());
  EXPECT_EQ(inbox.refused(), 2u);
}

TEST(WeightsInbox, CountsWhatWasOvertakenBeforeItWasTaken) {
  WeightsInbox inbox(kInboxSpec);
  Deliver(inbox, 1, 10, "a");
  ASSERT_TRUE(inbox.TryTake());
  Deliver(inbox, 1, 20, "b");
  EXPECT_EQ(inbox.overtaken(), 0u);
  Deliver(inbox, 1, 30, "c");
  Deliver(inbox, 1, 30, "c");
  Deliver(inbox, 1, 40, "d");
  EXPECT_EQ(inbox.overtaken(), 2u) << "20 and 30; a repetition counts for nothing";
}

TEST(WeightsInbox, PutsAVersionOfManyPartsTogether) {
  std::string large(3 * kBulkPartBytes + 5, 'x');
  large.back() = 'y';
  WeightsInbox inbox(kInboxSpec);
  Deliver(inbox, 1, 10, large);
  const auto weights = inbox.TryTake();
  ASSERT_TRUE(weights);
  EXPECT_TRUE(weights->payload.view() == large);
}

TEST(WeightsInbox, TakeWaitsForTheReceiveThread) {
  WeightsInbox inbox(kInboxSpec);
  std::thread receive([&] { Deliver(inbox, 1, 1, "x"); });
  EXPECT_TRUE(inbox.Take(Now() + std::chrono::seconds(10)));
  receive.join();
  EXPECT_FALSE(inbox.Take(Now()));
}

}  // namespace
}  // namespace shoal::actor
