// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/message_inbox.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <thread>

namespace shoal::launch {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(MessageInbox, GivesEveryMessageOnceInOrder) {
  MessageInbox<int> inbox(10);
  for (const int message : {1, 2, 3}) inbox.Put(message);
  EXPECT_THAT(inbox.TakeAll(), ElementsAre(1, 2, 3));
  EXPECT_THAT(inbox.TakeAll(), IsEmpty());
}

TEST(MessageInbox, DropsAndCountsWhatDoesNotFit) {
  MessageInbox<int> inbox(2);
  for (const int message : {1, 2, 3, 4}) inbox.Put(message);
  EXPECT_EQ(inbox.dropped(), 2u);
  EXPECT_THAT(inbox.TakeAll(), ElementsAre(1, 2));
  inbox.Put(5);
  EXPECT_THAT(inbox.TakeAll(), ElementsAre(5));
}

TEST(MessageInbox, LosesNothingBetweenTwoThreads) {
  constexpr size_t kMessages = 10'000;
  MessageInbox<size_t> inbox(100);
  std::atomic<bool> done = false;
  std::jthread sender([&] {
    for (size_t i = 0; i < kMessages; ++i) inbox.Put(i);
    done = true;
  });
  size_t taken = 0;
  std::optional<size_t> last;
  for (bool ended = false; !ended;) {
    ended = done;  // before the last look
    for (const size_t message : inbox.TakeAll()) {
      EXPECT_TRUE(!last || message > *last) << message;
      last = message;
      ++taken;
    }
  }
  EXPECT_EQ(taken + inbox.dropped(), kMessages);
}

}  // namespace
}  // namespace shoal::launch
