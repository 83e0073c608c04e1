// SPDX-License-Identifier: Apache-2.0
#include "actor/sending/credit_inbox.h"

#include <gtest/gtest.h>

#include <thread>

namespace shoal::actor {
namespace {

constexpr uint32_t kCreditedActor = 3;
constexpr uint64_t kCreditSession = 7;

Credit To(uint32_t actor, uint64_t session, uint64_t allowed) {
  return {.actor = actor, .session = session, .allowed = allowed};
}

TEST(CreditInbox, KeepsTheNewestWordToThisSessionOnly) {
  CreditInbox inbox(kCreditedActor, kCreditSession);
  EXPECT_FALSE(inbox.Take(Now()));
  inbox.OnMessage(
      {{To(kCreditedActor, kCreditSession, 10), To(kCreditedActor, kCreditSession, 20)}});
  inbox.OnMessage(
      {{To(kCreditedActor + 1, kCreditSession, 30), To(kCreditedActor, kCreditSession - 1, 40)}});
  const auto credit = inbox.Take(Now());
  ASSERT_TRUE(credit);
  EXPECT_EQ(credit->allowed, 20u);
  EXPECT_FALSE(inbox.Take(Now())) << "a word is taken once";
}

TEST(CreditInbox, WaitsUntilTheDeadlineForAWord) {
  CreditInbox inbox(kCreditedActor, kCreditSession);
  const SteadyTime start = Now();
  EXPECT_FALSE(inbox.Take(start + std::chrono::milliseconds(20)));
  EXPECT_GE(Now() - start, std::chrono::milliseconds(20));
}

TEST(CreditInbox, AWordFromAnotherThreadWakesTheWaitingOne) {
  CreditInbox inbox(kCreditedActor, kCreditSession);
  std::jthread sender([&] {
    for (uint64_t allowed = 1; allowed <= 1000; ++allowed) {
      inbox.OnMessage({{To(kCreditedActor, kCreditSession, allowed)}});
    }
  });
  uint64_t newest = 0;
  while (newest < 1000) {
    const auto credit = inbox.Take(Now() + std::chrono::seconds(30));
    ASSERT_TRUE(credit);
    ASSERT_GT(credit->allowed, newest) << "never an older word after a newer one";
    newest = credit->allowed;
  }
}

}  // namespace
}  // namespace shoal::actor
