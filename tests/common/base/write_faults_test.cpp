// SPDX-License-Identifier: Apache-2.0
#include "common/base/write_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "common/base/error.h"

namespace shoal {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(WriteFaults, AFaultIsSaidOnceAndItsEndOnce) {
  std::vector<std::string> said;
  WriteFaults faults([&](const std::string& line) { said.push_back(line); });
  const auto full = [] { throw RuntimeError("cannot write 'a': No space left on device"); };
  const auto written = [] {};
  EXPECT_TRUE(faults.Try("a", written));
  EXPECT_THAT(said, IsEmpty());
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(faults.Try("a", full));
  EXPECT_TRUE(faults.Try("b", written));
  EXPECT_THAT(said, ElementsAre(AllOf(HasSubstr("a: "), HasSubstr("No space left on device"))));
  EXPECT_THAT(faults.failing(), ElementsAre("a"));
  EXPECT_TRUE(faults.Try("a", written));
  EXPECT_TRUE(faults.Try("a", written));
  EXPECT_EQ(said.size(), 2u);
  EXPECT_EQ(said.back(), "a: written again");
  EXPECT_THAT(faults.failing(), IsEmpty());
}

TEST(WriteFaults, AFaultThatBeganElsewhereEndsHere) {
  std::vector<std::string> said;
  WriteFaults faults([&](const std::string& line) { said.push_back(line); }, {"a"});
  EXPECT_TRUE(faults.Try("b", [] {}));
  EXPECT_TRUE(faults.Try("a", [] {}));
  EXPECT_THAT(said, ElementsAre("a: written again"));
}

TEST(WriteFaults, ABugIsNoFaultOfTheDisk) {
  WriteFaults faults([](const std::string&) {});
  EXPECT_THROW(faults.Try("a", [] { throw std::logic_error("bug"); }), std::logic_error);
}

}  // namespace
}  // namespace shoal
