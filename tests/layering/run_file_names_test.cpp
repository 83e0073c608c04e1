// SPDX-License-Identifier: Apache-2.0
// The files of a run's folder are named in common/run_folder/run_file_names.h and nowhere else in
// the product, and docs/monitoring.md has the same names.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kHomesOfNames[] = {"common/run_folder/run_file_names.h",
                                         "common/checkpoint/checkpoint_files.h"};

std::string TextOf(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> NamesIn(const fs::path& header) {
  static const std::regex constant("constexpr char k\\w+\\[\\] = \"([^\"]+)\"");
  const std::string text = TextOf(header);
  std::vector<std::string> names;
  for (std::sregex_iterator it(text.begin(), text.end(), constant), end; it != end; ++it) {
    names.push_back((*it)[1]);
  }
  return names;
}

bool IsFileOrSchema(std::string_view name) {
  return name.starts_with("shoal-") || name.find('.') != std::string_view::npos;
}

// A string literal before a line's comment, and the code before it.
struct Literal {
  std::string before, text;
};

std::vector<Literal> LiteralsOf(const std::string& line) {
  std::vector<Literal> literals;
  if (line.starts_with("#include")) return literals;
  size_t open = std::string::npos;
  for (size_t i = 0; i < line.size(); ++i) {
    const bool inside = open != std::string::npos;
    if (inside && line[i] == '\\') {
      ++i;
    } else if (line[i] == '"') {
      if (inside) literals.push_back({line.substr(0, open), line.substr(open + 1, i - open - 1)});
      open = inside ? std::string::npos : i;
    } else if (!inside && (line.compare(i, 3, "'\"'") == 0 || line.compare(i, 4, "'\\\"'") == 0)) {
      i += line[i + 1] == '\\' ? 3 : 2;
    } else if (!inside && line.compare(i, 2, "//") == 0) {
      break;
    }
  }
  return literals;
}

// Whether a literal names the file, schema or folder. Sentences do not count. A name may have a
// suffix ("replay.ring.new"). Names of folders are also ordinary words, so they count only as a
// part of a path: `run / "logs"`.
bool Spells(const Literal& literal, const std::string& name) {
  const std::string& text = literal.text;
  if (text.find(' ') != std::string::npos) return false;
  if (name.ends_with('_') || name.ends_with('-')) return text == name;  // starts of names
  if (!IsFileOrSchema(name)) {
    return text == name && std::regex_search(literal.before, std::regex("/\\s*$"));
  }
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, '/');) {
    if (name.starts_with('.') ? part == name : part.starts_with(name)) return true;
  }
  return false;
}

// "FILE:LINE: NAME" for each name that the product spells outside of its defining files.
std::vector<std::string> FindSpelled(const fs::path& root, const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const char* top : {"actor", "common", "launch", "learner", "replay_server"}) {
    if (!fs::is_directory(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string file = entry.path().lexically_relative(root);
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      if (std::ranges::find(kHomesOfNames, file) != std::end(kHomesOfNames)) continue;
      std::ifstream in(entry.path());
      int number = 0;
      for (std::string line; std::getline(in, line);) {
        ++number;
        for (const Literal& literal : LiteralsOf(line)) {
          for (const std::string& name : names) {
            if (Spells(literal, name))
              found.push_back(fmt::format("{}:{}: {}", file, number, name));
          }
        }
      }
    }
  }
  std::ranges::sort(found);
  return found;
}

std::vector<std::string> NamesOfThisTree() {
  std::vector<std::string> names;
  for (const char* home : kHomesOfNames)
    std::ranges::copy(NamesIn(SourcePath(home)), back_inserter(names));
  // An experiment's folder has a lock of its own kind.
  std::erase(names, ".lock");
  return names;
}

TEST(RunFileNames, NoSourceOfTheProductSpellsOneBesideItsHome) {
  const std::vector<std::string> names = NamesOfThisTree();
  ASSERT_GT(names.size(), 35u);
  EXPECT_THAT(FindSpelled(SourcePath(""), names), IsEmpty());
}

TEST(RunFileNames, SpelledOnesAreFoundInPathsAndNotInSentences) {
  const TemporaryFolder tree;
  const auto write = [&](const std::string& file, const std::string& text) {
    fs::create_directories((tree.path() / file).parent_path());
    std::ofstream(tree.path() / file) << text;
  };
  write("launch/a.cpp",
        "f(run / \"config.json\");\n"
        "f(run / \"eval/final.json\", '\"', run / \"eval\");\n"
        "f(\"shoal-eval-1\") || name == \"config.json.new\";\n"
        "f(\"run folder (config.json)\"); g(\"eval\");  // run / \"eval\"\n"
        "#include \"config.json\"\n"
        "f(\"on-\") || f(\"on-line\");\n"
        "f(\"my-config.json\", \"\\\"config.json\", \"metadata.json\");\n");
  write("common/run_folder/run_file_names.h", "constexpr char kX[] = \"config.json\";\n");
  const std::vector<std::string> names = {"config.json", "eval", "final.json", "on-",
                                          "shoal-eval-1"};
  EXPECT_THAT(FindSpelled(tree.path(), names),
              ElementsAre("launch/a.cpp:1: config.json", "launch/a.cpp:2: eval",
                          "launch/a.cpp:2: final.json", "launch/a.cpp:3: config.json",
                          "launch/a.cpp:3: shoal-eval-1", "launch/a.cpp:6: on-"));
}

TEST(RunFileNames, ThePageOfMonitoringHasThem) {
  const std::string page = TextOf(SourcePath("docs/monitoring.md"));
  const size_t start = page.find("## The files of a run\n");
  ASSERT_NE(start, std::string::npos);
  const std::string section = page.substr(start, page.find("\n## ", start + 1) - start);
  for (const std::string& name : NamesIn(SourcePath(kHomesOfNames[0]))) {
    EXPECT_THAT(section, HasSubstr(name));
  }
}

}  // namespace
}  // namespace shoal
