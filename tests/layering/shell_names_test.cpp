// SPDX-License-Identifier: Apache-2.0
// `local NAME` in a function of a shell script fails when it runs if the script has `readonly
// NAME`. Neither `bash -n` nor shellcheck says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "common/base/files.h"
#include "tests/support/paths.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Names that lines declare which begin with `command`: NAME or NAME=VALUE. Nothing is read behind
// the first value that is an array or a command's output, because it can have spaces.
std::set<std::string> Declared(const std::string& script, const std::string& command) {
  std::set<std::string> names;
  std::istringstream lines(script);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word != command) continue;
    while (words >> word) {
      names.insert(word.substr(0, word.find('=')));
      if (word.find('(') != std::string::npos) break;
    }
  }
  return names;
}

std::vector<std::string> LocalsThatAreReadOnly(const std::string& script) {
  const std::set<std::string> constants = Declared(script, "readonly");
  std::vector<std::string> both;
  for (const std::string& name : Declared(script, "local")) {
    if (constants.contains(name)) both.push_back(name);
  }
  return both;
}

std::vector<fs::path> Scripts() {
  std::vector<fs::path> scripts = {SourcePath("run")};
  for (const char* folder : {"launch", "tests"}) {
    for (const auto& file : fs::recursive_directory_iterator(SourcePath(folder))) {
      if (file.path().extension() == ".sh") scripts.push_back(file.path());
    }
  }
  return scripts;
}

TEST(ShellNames, NoLocalVariableHasTheNameOfAConstant) {
  const std::vector<fs::path> scripts = Scripts();
  EXPECT_GE(scripts.size(), 10u);
  for (const fs::path& script : scripts) {
    EXPECT_THAT(LocalsThatAreReadOnly(ReadFile(script)), IsEmpty()) << script;
  }
}

TEST(ShellNames, ALocalWithTheNameOfAConstantIsFound) {
  EXPECT_THAT(LocalsThatAreReadOnly("readonly packages=(a b)\n"
                                    "readonly root source\n"
                                    "pack() {\n"
                                    "  local out packages=$!\n"
                                    "  local made=$(pack root)\n"
                                    "  local other=$root\n"
                                    "}\n"),
              ElementsAre("packages"));
}

}  // namespace
}  // namespace shoal
