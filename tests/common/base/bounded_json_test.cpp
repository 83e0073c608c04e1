// SPDX-License-Identifier: Apache-2.0
#include "common/base/bounded_json.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "common/base/files.h"
#include "tests/support/paths.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

std::string Nested(int depth) {
  return std::string(static_cast<size_t>(depth), '[') +
         std::string(static_cast<size_t>(depth), ']');
}

TEST(BoundedJson, TakesTheDepthThatIsAllowedAndNoMore) {
  EXPECT_TRUE(ParseBoundedJson<nlohmann::json>(Nested(kMaxJsonDepth)).is_array());
  EXPECT_TRUE(ParseBoundedJson<nlohmann::json>(Nested(kMaxJsonDepth + 1)).is_discarded());
  EXPECT_TRUE(ParseBoundedJson<nlohmann::ordered_json>(Nested(300'000)).is_discarded());
}

TEST(BoundedJson, CountsWhatIsOpenNotWhatIsThere) {
  std::string many = "[";
  for (int i = 0; i < 10'000; ++i) many += R"({"a": [1]},)";
  many += "1]";
  EXPECT_FALSE(JsonTooDeep(many));
  EXPECT_EQ(ParseBoundedJson<nlohmann::json>(many).size(), 10'001u);
}

TEST(BoundedJson, BracketsOfTextAreText) {
  const std::string brackets(1000, '[');
  EXPECT_FALSE(JsonTooDeep('"' + brackets + '"'));
  EXPECT_FALSE(JsonTooDeep(R"("a\")" + brackets + '"'))
      << "the text goes on behind an escaped quote";
  EXPECT_TRUE(JsonTooDeep(R"("a\\")" + brackets)) << "but not behind an escaped backslash";
}

TEST(BoundedJson, WhatIsNotJsonIsDiscarded) {
  for (const char* text : {"", "[", "{\"a\" 1}", "]]]]", "\"\\"}) {
    EXPECT_TRUE(ParseBoundedJson<nlohmann::json>(text).is_discarded()) << text;
  }
}

// Other ways to parse JSON have no limit of depth.
TEST(BoundedJson, TheProductParsesJsonInNoOtherWay) {
  int sources = 0;
  for (const char* room : {"common", "actor", "replay_server", "learner", "launch"}) {
    for (const auto& entry : fs::recursive_directory_iterator(SourcePath(room))) {
      const std::string extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".h") continue;
      ++sources;
      const std::string name = entry.path().filename();
      const std::string text = ReadFile(entry.path());
      const bool parses = text.find("json::parse(") != std::string::npos ||
                          text.find("Json::parse(") != std::string::npos;
      if (name == "bounded_json.h" || !parses) continue;
      EXPECT_NE(text.find("JsonTooDeep("), std::string::npos) << entry.path();
    }
  }
  EXPECT_GT(sources, 300);
}

}  // namespace
}  // namespace shoal
