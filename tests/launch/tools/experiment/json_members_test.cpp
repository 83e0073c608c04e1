// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/json_members.h"

#include <gtest/gtest.h>

#include "tests/support/error_message.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

TEST(JsonMembers, NamesTheMemberAndTheSource) {
  const ordered_json object{{"a", 1}, {"b", ""}, {"c", "text"}};
  JsonMembers members(object, "x.json");
  EXPECT_EQ(members.NeedText("c"), "text");
  EXPECT_EQ(members.Text("d", "absent"), "absent");
  EXPECT_EQ(UsageMessage([&] { members.Text("a", ""); }), "x.json: a = 1: expected a string");
  EXPECT_EQ(UsageMessage([&] { members.NeedText("b"); }),
            "x.json: b = \"\": expected a string that is not empty");
  EXPECT_EQ(UsageMessage([&] { members.Need("e"); }), "x.json: 'e' is missing");
}

TEST(JsonMembers, RefusesMembersThatNobodyAskedFor) {
  const ordered_json object{{"a", 1}, {"b", 2}};
  JsonMembers members(object, "x.json");
  members.Find("a");
  members.Find("c");
  EXPECT_EQ(UsageMessage([&] { members.RefuseOthers(); }),
            "x.json: unknown member 'b', there are: a, c");
  members.Find("b");
  EXPECT_EQ(UsageMessage([&] { members.RefuseOthers(); }), "");
  EXPECT_EQ(UsageMessage([] { JsonMembers(ordered_json::array(), "x.json"); }),
            "x.json: expected a JSON object");
}

TEST(IncreasingNumbers, AreIntegersOfAtLeastOne) {
  EXPECT_EQ(IncreasingNumbers({1, 3, 100}), (std::vector<int64_t>{1, 3, 100}));
  for (const char* text : {"[]", "[0]", "[-1]", "[3, 3]", "[3, 2]", "[1.5]", "[\"1\"]", "5", "{}",
                           "[18446744073709551615]"}) {
    EXPECT_FALSE(IncreasingNumbers(ordered_json::parse(text))) << text;
  }
}

}  // namespace
}  // namespace shoal::launch
