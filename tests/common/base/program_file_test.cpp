// SPDX-License-Identifier: Apache-2.0
#include "common/base/program_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace shoal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kLoader = "/opt/shoal/lib/ld-linux-x86-64.so.2";

std::string Line(std::initializer_list<const char*> words) {
  std::string line;
  for (const char* word : words) line += std::string(word) + '\0';
  return line;
}

TEST(ProgramFile, IsTheExecutableThatTheKernelStarted) {
  EXPECT_EQ(ProgramFileOf("/usr/bin/shoal", "anything"), "/usr/bin/shoal");
  EXPECT_THAT(ProgramFile().string(), HasSubstr("common_base_test"));
}

TEST(ProgramFile, OfABundleItIsTheOneBesideTheLoader) {
  EXPECT_EQ(ProgramFileOf(kLoader, "shoal-actor"), "/opt/shoal/bin/shoal-actor");
}

TEST(ProgramWords, AreThoseOfTheProgramAlone) {
  EXPECT_THAT(ProgramWordsOf("/usr/bin/shoal", Line({"shoal", "train", "", "--argv0"})),
              ElementsAre("shoal", "train", "", "--argv0"));
  EXPECT_THAT(ProgramWordsOf(kLoader, Line({kLoader.c_str(), "--inhibit-cache", "--library-path",
                                            "/opt/shoal/lib", "--argv0", "/opt/shoal/bin/shoal",
                                            "/opt/shoal/libexec/shoal", "train", "--argv0", ""})),
              ElementsAre("/opt/shoal/bin/shoal", "train", "--argv0", ""));
  EXPECT_THAT(ProgramWordsOf(kLoader, Line({kLoader.c_str(), "--argv0", "shoal", "shoal"})),
              ElementsAre("shoal"));
}

}  // namespace
}  // namespace shoal
