// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/access.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

constexpr char kToken[] = "0123456789abcdef0123456789abcdef";
constexpr char kWrong[] = "0123456789abcdef0123456789abcdee";

const Gate kLoopback({.address = "127.0.0.1", .port = 8470}, kToken);
const Gate kNetwork({.address = "10.0.0.7", .port = 8470}, kToken);

// A caller on loopback who wants to act, from the page.
Caller Actor() {
  return {.acts = true,
          .host = "127.0.0.1:8470",
          .origin = "http://127.0.0.1:8470",
          .fetch_site = "same-origin",
          .header_token = kToken,
          .cookie_token = "",
          .query_token = ""};
}

TEST(Access, OnLoopbackWhoeverIsOnThisHostMayLook) {
  for (const char* host : {"127.0.0.1:8470", "localhost:8470", "localhost:9000", "127.0.0.1"}) {
    EXPECT_EQ(kLoopback.Decide({.host = host}), Access::kAllowed) << host;
  }
}

TEST(Access, AnotherNameThatPointsHereIsForeign) {
  for (const char* host : {"evil.example:8470", "evil.example", "", "localhost.evil.example:8470",
                           "127.0.0.1.evil.example", "10.0.0.7:8470"}) {
    EXPECT_EQ(kLoopback.Decide({.host = host}), Access::kForeign) << host;
  }
}

TEST(Access, AtAnotherAddressNothingIsShownWithoutTheToken) {
  EXPECT_EQ(kNetwork.Decide({.host = "10.0.0.7:8470"}), Access::kNoToken);
  EXPECT_EQ(kNetwork.Decide({.query_token = kWrong}), Access::kNoToken);
  EXPECT_EQ(kNetwork.Decide({.query_token = "0123"}), Access::kNoToken);
  EXPECT_EQ(kNetwork.Decide({.query_token = kToken}), Access::kAllowed);
  EXPECT_EQ(kNetwork.Decide({.cookie_token = kToken}), Access::kAllowed);
  EXPECT_EQ(kNetwork.Decide({.header_token = kToken}), Access::kAllowed);
}

TEST(Access, ActingTakesTheTokenInItsHeader) {
  EXPECT_EQ(kLoopback.Decide(Actor()), Access::kAllowed);
  Caller caller = Actor();
  caller.header_token = kWrong;
  EXPECT_EQ(kLoopback.Decide(caller), Access::kNoToken);
  // Data that a browser sends by itself, or that a link contains, is not enough.
  caller.header_token = "";
  caller.cookie_token = caller.query_token = kToken;
  EXPECT_EQ(kLoopback.Decide(caller), Access::kNoToken);
}

TEST(Access, ActingFromAnotherPageIsForeignEvenWithTheToken) {
  Caller caller = Actor();
  caller.origin = "http://evil.example";
  EXPECT_EQ(kLoopback.Decide(caller), Access::kForeign);
  caller.origin = "null";
  EXPECT_EQ(kLoopback.Decide(caller), Access::kForeign);
  caller = Actor();
  caller.fetch_site = "cross-site";
  EXPECT_EQ(kLoopback.Decide(caller), Access::kForeign);
  caller.fetch_site = "same-site";  // another port of this host
  EXPECT_EQ(kLoopback.Decide(caller), Access::kForeign);
  // A program other than a browser sends neither header.
  caller.fetch_site = caller.origin = "";
  EXPECT_EQ(kLoopback.Decide(caller), Access::kAllowed);
}

TEST(Access, TokensAreLongAndNoTwoAreEqual) {
  const std::string token = MakeToken();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token, MakeToken());
}

TEST(Access, EqualInConstantTimeIsEqual) {
  EXPECT_TRUE(EqualInConstantTime(kToken, kToken));
  EXPECT_FALSE(EqualInConstantTime(kToken, kWrong));
  EXPECT_FALSE(EqualInConstantTime(kToken, ""));
  EXPECT_FALSE(EqualInConstantTime("abc", "xbc"));
  EXPECT_FALSE(EqualInConstantTime("ab", "abc"));
}

TEST(Access, ACookieIsFoundByItsWholeName) {
  EXPECT_EQ(CookieValue("a=1; shoal_token_1=x; b=2", "shoal_token_1"), "x");
  EXPECT_EQ(CookieValue("shoal_token_12=y", "shoal_token_1"), "");
  EXPECT_EQ(CookieValue("xshoal_token_1=y;shoal_token_1=z", "shoal_token_1"), "z");
  EXPECT_EQ(CookieValue("shoal_token_1=", "shoal_token_1"), "");
  EXPECT_EQ(CookieValue(" ; ;=;", "shoal_token_1"), "");
  EXPECT_EQ(CookieValue("", "shoal_token_1"), "");
}

}  // namespace
}  // namespace shoal::launch
