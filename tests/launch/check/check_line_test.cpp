// SPDX-License-Identifier: Apache-2.0
#include "launch/check/check_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/error.h"

namespace shoal::launch {
namespace {

using testing::HasSubstr;

TEST(CheckLine, WhatALookThrowsIsAFailWithItsWordsAndAdvice) {
  const CheckLine line = Guarded("disk", "free some",
                                 []() -> CheckLine { throw RuntimeError("no room in '{}'", "x"); });
  EXPECT_EQ(line.name, "disk");
  EXPECT_EQ(line.verdict, Verdict::kFail);
  EXPECT_EQ(line.finding, "no room in 'x'");
  EXPECT_EQ(line.advice, "free some");
}

TEST(CheckLine, ALookThatSucceedsIsHandedOnUnchanged) {
  const CheckLine line = Guarded("disk", "free some", [] {
    return CheckLine{"disk", Verdict::kOk, "fine", ""};
  });
  EXPECT_EQ(line.verdict, Verdict::kOk);
  EXPECT_EQ(line.finding, "fine");
  EXPECT_EQ(line.advice, "");
}

TEST(CheckLine, TheWorstVerdictCounts) {
  const CheckLine ok{"a", Verdict::kOk, "", ""}, warn{"b", Verdict::kWarn, "", ""},
      fail{"c", Verdict::kFail, "", ""};
  EXPECT_EQ(Worst({}), Verdict::kOk);
  EXPECT_EQ(Worst({ok, warn, ok}), Verdict::kWarn);
  EXPECT_EQ(Worst({fail, warn, ok}), Verdict::kFail);
}

TEST(CheckLine, PrintsTheAdviceBelowAndOnlyWhereThereIsOne) {
  EXPECT_THAT(ToText({"cpu", Verdict::kWarn, "old", "buy a new one"}),
              testing::AllOf(HasSubstr("WARN  cpu"), HasSubstr("old\n"), HasSubstr("-> buy")));
  EXPECT_EQ(ToText({"cpu", Verdict::kOk, "new", ""}).find("->"), std::string::npos);
}

TEST(CheckLine, JsonHoldsEveryLineAndTheWorstVerdict) {
  const auto json =
      ToJson({{"cpu", Verdict::kWarn, "old", "newer"}, {"disk", Verdict::kOk, "", ""}}, 1.5,
             {{"cores", 2}});
  EXPECT_EQ(json.at("schema"), "shoal-check-1");
  EXPECT_EQ(json.at("verdict"), "WARN");
  EXPECT_EQ(json.at("seconds"), 1.5);
  EXPECT_EQ(json.at("machine").at("cores"), 2);
  ASSERT_EQ(json.at("checks").size(), 2u);
  EXPECT_EQ(json.at("checks")[0].at("name"), "cpu");
  EXPECT_EQ(json.at("checks")[0].at("verdict"), "WARN");
  EXPECT_EQ(json.at("checks")[0].at("finding"), "old");
  EXPECT_EQ(json.at("checks")[0].at("advice"), "newer");
}

}  // namespace
}  // namespace shoal::launch
