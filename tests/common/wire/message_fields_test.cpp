// SPDX-License-Identifier: Apache-2.0
// Compares the lists of fields with the structs and with the types on the wire, by name: the
// compiler compares their number and types alone.
#include "common/wire/message_fields.h"

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/files.h"
#include "tests/support/paths.h"

namespace shoal {
namespace {

using Fields = std::vector<std::string>;

std::string WithoutComments(const std::string& text) {
  return std::regex_replace(text, std::regex("//[^\n]*"), "");
}

std::vector<std::smatch> Matches(const std::string& text, const std::regex& pattern) {
  return {std::sregex_iterator(text.begin(), text.end(), pattern), std::sregex_iterator()};
}

// By message, its fields as message_fields.h names them: "version.session".
std::map<std::string, Fields> ListedFields() {
  const std::string source = WithoutComments(ReadFile(SourcePath("common/wire/message_fields.h")));
  std::map<std::string, Fields> lists;
  for (const std::smatch& list :
       Matches(source, std::regex(R"(FieldsAsIn<(\w+)> M>([\s\S]*?)\n\})"))) {
    const std::string body = list[2];
    Fields& fields = lists[list[1]];
    for (const std::smatch& field : Matches(body, std::regex(R"(\bm\.([\w.\[\]]+))"))) {
      fields.push_back(field[1]);
    }
  }
  return lists;
}

// By type, its fields as shoal.idl names them, but for the version of bulk types.
std::map<std::string, Fields> WireFields() {
  const std::string source = WithoutComments(ReadFile(SourcePath("common/dds/shoal.idl")));
  std::map<std::string, Fields> types;
  for (const std::smatch& type : Matches(source, std::regex(R"(struct (\w+) \{([^}]*)\})"))) {
    const std::string body = type[2];
    Fields& fields = types[type[1]];
    for (const std::smatch& field : Matches(body, std::regex(R"((\w+);)"))) {
      if (field[1] != "version") fields.push_back(field[1]);
    }
  }
  return types;
}

// Members of each struct of messages.h.
std::map<std::string, std::set<std::string>> Members() {
  const std::string source = WithoutComments(ReadFile(SourcePath("common/wire/messages.h")));
  std::map<std::string, std::set<std::string>> structs;
  for (const std::smatch& type :
       Matches(source, std::regex(R"(struct (\w+) \{\n([\s\S]*?)\n\};)"))) {
    const std::string body = type[2];
    std::set<std::string>& members = structs[type[1]];
    for (const std::smatch& line :
         Matches(body, std::regex(R"(^  (?!static)[\w:]+(?:<[^;]*?>)? (\w[^;()]*);)",
                                  std::regex::multiline))) {
      const std::string names = std::regex_replace(line[1].str(), std::regex(R"(\{[^}]*\})"), "");
      for (const std::smatch& name : Matches(names, std::regex(R"((?:^|, )(\w+))"))) {
        members.insert(name[1]);
      }
    }
  }
  return structs;
}

// The name of a field in shoal.idl.
std::string WireName(const std::string& field) {
  static const std::map<std::string, std::string> names{{"version.session", "weights_session"},
                                                        {"version.update", "weights_update"},
                                                        {"address.token[0]", "token_first"},
                                                        {"address.token[1]", "token_second"},
                                                        {"credits", "changed"}};
  const auto found = names.find(field);
  return found != names.end() ? found->second : field.substr(field.find('.') + 1);
}

// The type in shoal.idl of a struct.
std::string WireTypeName(const std::string& message) {
  const std::string_view suffix = "Message";
  return message.ends_with(suffix) ? message.substr(0, message.size() - suffix.size()) : message;
}

TEST(MessageFields, HaveTheNamesAndTheOrderOfTheWire) {
  const auto types = WireFields();
  const auto lists = ListedFields();
  EXPECT_EQ(lists.size(), types.size());
  for (const auto& [message, fields] : lists) {
    Fields names;
    names.reserve(fields.size());
    for (const std::string& field : fields) names.push_back(WireName(field));
    const auto type = types.find(WireTypeName(message));
    ASSERT_TRUE(type != types.end()) << message;
    EXPECT_EQ(names, type->second) << message;
  }
}

TEST(MessageFields, AreAllMembersOfTheStruct) {
  const auto structs = Members();
  for (const auto& [message, fields] : ListedFields()) {
    std::set<std::string> listed;
    for (const std::string& field : fields) listed.insert(field.substr(0, field.find('.')));
    ASSERT_TRUE(structs.contains(message)) << message;
    EXPECT_EQ(listed, structs.at(message)) << message;
  }
}

TEST(MessageFields, OfADerivedMessageAreThoseOfItsBase) {
  EvalWeightsPart part;
  part.part = 3;
  part.version.update = 5;
  EXPECT_EQ(std::get<0>(FieldsOf(part)), 3u);
  std::get<3>(FieldsOf(part)) = 6;
  EXPECT_EQ(part.version.update, 6u);
}

}  // namespace
}  // namespace shoal
