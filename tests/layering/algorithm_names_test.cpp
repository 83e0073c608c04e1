// SPDX-License-Identifier: Apache-2.0
// An algorithm consists of a folder of learner/agent, a line in each of two lists, and its keys.
// Its name does not occur elsewhere in the product (docs/decisions/0008).
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr char kList[] = "learner/agent/algorithms.cpp";
const std::set<std::string> kMayName = {
    kList, "common/config/algorithm_kind.cpp",
    // The schema: sections of keys with defaults and descriptions.
    "common/config/algorithm_config.h", "common/config/config.h", "common/config/config_keys.cpp",
    // The algorithm of old checkpoints, which do not name it.
    "common/checkpoint/checkpoint_files.h",
    // An encoder that has the name of an algorithm.
    "common/nn/encoders/encoder_kind.h", "common/nn/encoders/encoder_kind.cpp",
    "common/nn/encoders/mrq.cpp"};

// Folders of learner/agent that the list names; others are shared by several algorithms.
std::set<std::string> AlgorithmsOf(const fs::path& root) {
  std::ifstream in(root / kList);
  std::ostringstream list;
  list << in.rdbuf();
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(root / "learner/agent")) {
    const std::string name = entry.path().filename();
    if (entry.is_directory() && list.str().find('"' + name + '"') != std::string::npos) {
      names.insert(name);
    }
  }
  return names;
}

std::string WithoutComment(const std::string& line) {
  bool text = false;
  for (size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && (i == 0 || line[i - 1] != '\\')) text = !text;
    if (text || line[i] != '/') continue;
    if (line.compare(i, 2, "//") == 0 || line.compare(i, 2, "/*") == 0) return line.substr(0, i);
  }
  return line;
}

std::string Lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

// The words of a line in lower case, including words of kCamelCase and snake_case names. The
// section of a key is left out: "ppo.epochs", config.ppo.epochs.
std::set<std::string> WordsOf(const std::string& line) {
  static const std::regex word("[A-Z]?[a-z0-9]+|[A-Z]+(?![a-z])|[A-Z]");
  static const std::regex key("\\.[a-z]");
  std::set<std::string> words;
  for (std::sregex_iterator it(line.begin(), line.end(), word), end; it != end; ++it) {
    if (!std::regex_search(it->suffix().str(), key, std::regex_constants::match_continuous)) {
      words.insert(Lower(it->str()));
    }
  }
  return words;
}

// "FILE:LINE: NAME" for each name in a wrong place.
std::vector<std::string> FindNamed(const fs::path& root) {
  const std::set<std::string> names = AlgorithmsOf(root);
  std::vector<std::string> found;
  for (const char* top : {"actor", "common", "launch", "learner", "replay_server"}) {
    if (!fs::is_directory(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string file = entry.path().lexically_relative(root);
      const std::string extension = entry.path().extension();
      if ((extension != ".h" && extension != ".cpp") || kMayName.contains(file)) continue;
      std::ifstream in(entry.path());
      int number = 0;
      for (std::string line; std::getline(in, line);) {
        ++number;
        const std::string lower = Lower(line);
        for (const std::string& name : names) {
          if (lower.find(name) == std::string::npos) continue;
          if (WordsOf(WithoutComment(line)).contains(name) &&
              !file.starts_with("learner/agent/" + name + "/")) {
            found.push_back(fmt::format("{}:{}: {}", file, number, name));
          }
        }
      }
    }
  }
  std::ranges::sort(found);
  return found;
}

TEST(AlgorithmNames, StandInTheirFolderAndInTheListsAlone) {
  ASSERT_THAT(AlgorithmsOf(SourcePath("")),
              ElementsAre("ddpg", "drqv2", "mrq", "ppo", "sac", "td3"));
  EXPECT_THAT(FindNamed(SourcePath("")), IsEmpty());
}

TEST(AlgorithmNames, AreFoundInCodeAndTextsButNotInCommentsAndKeys) {
  const TemporaryFolder tree;
  const auto write = [&](const std::string& file, const std::string& text) {
    fs::create_directories((tree.path() / file).parent_path());
    std::ofstream(tree.path() / file) << text;
  };
  write("learner/agent/algorithms.cpp", "{.name = \"abc\", .make = MakeAbcAgent}\n");
  write("learner/agent/abc/abc_agent.cpp", "#include \"learner/agent/abc/abc_agent.h\"\n");
  write("learner/agent/shared/a.cpp", "MakeShared();\n");
  write("actor/a.cpp",
        "f();  // as abc does\n"
        "if (algorithm == \"abc\") kShared();\n"
        "config.abc.epochs; Say(\"abc.epochs\"); abcd(); \"http://x\";\n"
        "MakeAbcAgent();\n"
        "kAbcFigures;\n"
        "ABC; /* abc_ */\n"
        "Say(\"http://abc\");\n");
  write("learner/a.cpp", "#include \"learner/agent/abc/abc_agent.h\"\n");
  EXPECT_THAT(FindNamed(tree.path()),
              ElementsAre("actor/a.cpp:2: abc", "actor/a.cpp:4: abc", "actor/a.cpp:5: abc",
                          "actor/a.cpp:6: abc", "actor/a.cpp:7: abc", "learner/a.cpp:1: abc"));
}

}  // namespace
}  // namespace shoal
