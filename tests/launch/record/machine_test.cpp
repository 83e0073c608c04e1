// SPDX-License-Identifier: Apache-2.0
#include "launch/record/machine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace shoal::launch {
namespace {

TEST(CpuName, TellsCpusOfOneNameApart) {
  const std::string first =
      "processor\t: 0\nvendor_id\t: AuthenticAMD\ncpu family\t: 25\nmodel\t\t: 17\n"
      "model name\t: AMD EPYC\n\nprocessor\t: 1\ncpu family\t: 26\nmodel\t\t: 2\n"
      "model name\t: another\n";
  EXPECT_EQ(CpuName(first), "AMD EPYC (family 25, model 17)");
  EXPECT_EQ(CpuName("model name\t: X\nmodel\t\t: 17\ncpu family\t: 6\n"), "X (family 6, model 17)");
}

TEST(CpuName, IsTheNameAloneWhereThatIsAllThereIs) {
  EXPECT_EQ(CpuName("model name\t: POWER9\nmodel\t\t: 17"), "POWER9");
  EXPECT_EQ(CpuName("cpu family\t: 25\nmodel\t\t: 17\n"), "unknown");
  EXPECT_EQ(CpuName(": \n:\n\n"), "unknown");
  EXPECT_EQ(CpuName(""), "unknown");
}

TEST(DescribeMachine, NamesTheFamilyOfThisCpu) {
  const auto machine = DescribeMachine();
  EXPECT_THAT(machine.at("cpu").get<std::string>(),
              testing::MatchesRegex(".+ \\(family [0-9]+, model [0-9]+\\)"));
  EXPECT_GT(machine.at("cores").get<int>(), 0);
}

}  // namespace
}  // namespace shoal::launch
