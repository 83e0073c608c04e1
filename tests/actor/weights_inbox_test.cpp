#include "actor/weights_inbox.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "common/base/crc32.h"

namespace shoal::actor {
namespace {

constexpr uint64_t kSpec = 5;

void Deliver(WeightsInbox& inbox, uint64_t session, uint64_t update, const std::string& payload,
             uint64_t spec = kSpec, uint32_t crc_error = 0) {
  WeightsMessage message;
  message.spec_hash = spec;
  message.version = {session, update};
  message.payload = {reinterpret_cast<const uint8_t*>(payload.data()), payload.size()};
  message.crc = Crc32(message.payload) ^ crc_error;
  inbox.OnMessage(message);
}

TEST(WeightsInbox, KeepsOnlyTheNewest) {
  WeightsInbox inbox(kSpec);
  EXPECT_FALSE(inbox.TryTake());
  Deliver(inbox, 1, 10, "a");
  Deliver(inbox, 1, 30, "c");
  Deliver(inbox, 1, 20, "b");
  const auto weights = inbox.TryTake();
  ASSERT_TRUE(weights);
  EXPECT_EQ(weights->version.update, 30u);
  EXPECT_EQ(weights->payload, "c");
  EXPECT_FALSE(inbox.TryTake());
}

TEST(WeightsInbox, ANewerLearnerSessionWinsWhateverItsUpdate) {
  WeightsInbox inbox(kSpec);
  Deliver(inbox, 1, 500, "old");
  ASSERT_TRUE(inbox.TryTake());
  Deliver(inbox, 2, 400, "restored");
  EXPECT_EQ(inbox.TryTake()->payload, "restored");
  Deliver(inbox, 1, 501, "ghost");
  EXPECT_FALSE(inbox.TryTake());
}

TEST(WeightsInbox, RefusesForeignAndDamagedWeights) {
  WeightsInbox inbox(kSpec);
  Deliver(inbox, 1, 1, "x", kSpec + 1);
  Deliver(inbox, 1, 1, "x", kSpec, /*crc_error=*/1);
  EXPECT_FALSE(inbox.TryTake());
  EXPECT_EQ(inbox.refused(), 2u);
}

TEST(WeightsInbox, CountsWhatWasOvertakenBeforeItWasTaken) {
  WeightsInbox inbox(kSpec);
  Deliver(inbox, 1, 10, "a");
  ASSERT_TRUE(inbox.TryTake());
  Deliver(inbox, 1, 20, "b");
  EXPECT_EQ(inbox.overtaken(), 0u);
  Deliver(inbox, 1, 30, "c");
  Deliver(inbox, 1, 30, "c");
  Deliver(inbox, 1, 40, "d");
  EXPECT_EQ(inbox.overtaken(), 2u) << "20 and 30; a repetition counts for nothing";
}

TEST(WeightsInbox, TakeWaitsForTheReceiveThread) {
  WeightsInbox inbox(kSpec);
  std::thread receive([&] { Deliver(inbox, 1, 1, "x"); });
  EXPECT_TRUE(inbox.Take(Now() + std::chrono::seconds(10)));
  receive.join();
  EXPECT_FALSE(inbox.Take(Now()));
}

}  // namespace
}  // namespace shoal::actor
