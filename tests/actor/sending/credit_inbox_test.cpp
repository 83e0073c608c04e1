#include "actor/sending/credit_inbox.h"

#include <gtest/gtest.h>

#include <thread>

namespace shoal::actor {
namespace {

constexpr uint32_t kActor = 3;
constexpr uint64_t kSession = 7;

Credit To(uint32_t actor, uint64_t session, uint64_t allowed) {
  return {.actor = actor, .session = session, .allowed = allowed};
}

TEST(CreditInbox, KeepsTheNewestWordToThisSessionOnly) {
  CreditInbox inbox(kActor, kSession);
  EXPECT_FALSE(inbox.Take(Now()));
  inbox.OnMessage({{To(kActor, kSession, 10), To(kActor, kSession, 20)}});
  inbox.OnMessage({{To(kActor + 1, kSession, 30), To(kActor, kSession - 1, 40)}});
  const auto credit = inbox.Take(Now());
  ASSERT_TRUE(credit);
  EXPECT_EQ(credit->allowed, 20u);
  EXPECT_FALSE(inbox.Take(Now())) << "a word is taken once";
}

TEST(CreditInbox, WaitsUntilTheDeadlineForAWord) {
  CreditInbox inbox(kActor, kSession);
  const SteadyTime start = Now();
  EXPECT_FALSE(inbox.Take(start + std::chrono::milliseconds(20)));
  EXPECT_GE(Now() - start, std::chrono::milliseconds(20));
}

TEST(CreditInbox, AWordFromAnotherThreadWakesTheWaitingOne) {
  CreditInbox inbox(kActor, kSession);
  std::jthread sender([&] {
    for (uint64_t allowed = 1; allowed <= 1000; ++allowed) {
      inbox.OnMessage({{To(kActor, kSession, allowed)}});
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
