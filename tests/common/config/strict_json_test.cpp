// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/config/config_io.h"

namespace shoal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string Mistake(const std::string& text) {
  try {
    ParseStrictJson(text, "x.json");
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 2);
    return e.what();
  }
  return "";
}

TEST(ParseStrictJson, ReturnsTheValue) {
  EXPECT_EQ(ParseStrictJson(R"({"a": [1, {"b": 2}]})", "x")["a"][1]["b"], 2);
}

TEST(ParseStrictJson, RefusesADuplicateKeyNamingItsPath) {
  EXPECT_THAT(Mistake(R"({"a": 1, "b": {"c": 1, "d": 2, "c": 1}})"), HasSubstr("'b.c'"));
  EXPECT_THAT(Mistake(R"({"a": 1, "a": 1})"), AllOf(HasSubstr("x.json"), HasSubstr("'a'")));
  EXPECT_THAT(Mistake(R"({"l": [{"k": 1, "k": 2}]})"), HasSubstr("'l.k'"));
}

TEST(ParseStrictJson, AllowsTheSameKeyInDifferentObjects) {
  EXPECT_EQ(Mistake(R"({"a": {"k": 1}, "k": 2})"), "");
  EXPECT_EQ(Mistake(R"({"a": {"k": 1}, "b": {"k": 1, "a": 2}, "l": [{"k": 1}, {"k": 2}]})"), "");
}

TEST(ParseStrictJson, SaysWhereTheTextIsBroken) {
  EXPECT_THAT(Mistake("{\"a\": 1,\n \"b\" 2}"), AllOf(HasSubstr("x.json"), HasSubstr("line 2")));
  EXPECT_THAT(Mistake(""), HasSubstr("not valid JSON"));
  EXPECT_THAT(Mistake("{} {}"), HasSubstr("not valid JSON"));
  EXPECT_THAT(Mistake("{\"a\": 1e999}"), HasSubstr("not valid JSON"));
}

TEST(ParseStrictJson, RefusesADeepNestingInOneShortLine) {
  const std::string deep = R"({"seed": )" + std::string(300'000, '[') + std::string(300'000, ']');
  EXPECT_EQ(Mistake(deep + "}"), "x.json: nested more than 64 deep");
}

TEST(ParseStrictJson, QuotesLittleOfALongToken) {
  EXPECT_LT(Mistake("{\"a\": \"" + std::string(100'000, 'x')).size(), 500u);
}

}  // namespace
}  // namespace shoal
