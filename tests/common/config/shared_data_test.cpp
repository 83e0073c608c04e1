// SPDX-License-Identifier: Apache-2.0
#include "common/config/shared_data.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/files.h"
#include "common/config/config_io.h"
#include "tests/support/error_message.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::Not;

// The working folder of this process, put back at the end.
class WorkingFolder {
 public:
  explicit WorkingFolder(const fs::path& folder) : before_(fs::current_path()) {
    fs::current_path(folder);
  }
  ~WorkingFolder() { fs::current_path(before_); }

 private:
  fs::path before_;
};

TEST(SharedData, IsFoundFromAnyFolder) {
  const TemporaryFolder folder;
  const WorkingFolder here(folder.path());
  for (const char* kind : {"presets", "experiments", "references"}) {
    const fs::path source = SourcePath(std::string("launch/data/") + kind);
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(source)) names.push_back(entry.path().stem());
    std::ranges::sort(names);
    EXPECT_EQ(ListSharedData(kind), names);
    for (const std::string& name : names) {
      ASSERT_TRUE(FindSharedData(kind, name)) << name;
      EXPECT_EQ(ReadFile(*FindSharedData(kind, name)), ReadFile(source / (name + ".json")));
    }
  }
}

TEST(SharedData, AProjectsOwnComesFirstInItsFolderAlone) {
  const TemporaryFolder folder;
  MakeFolders(folder.path() / "presets");
  WriteFileAtomically(folder.path() / "presets/mine.json", R"({"seed": 7})");
  WriteFileAtomically(folder.path() / "presets/fetch-reach-drq.json", R"({"seed": 8})");
  const WorkingFolder here(folder.path());
  EXPECT_THAT(ListPresets(), Not(Contains("mine")));
  EXPECT_EQ(LoadPreset("fetch-reach-drq").seed, 1);
  WriteFileAtomically(folder.path() / kProjectFile, "{}");
  EXPECT_THAT(ListPresets(), Contains("mine"));
  EXPECT_EQ(LoadPreset("mine").seed, 7);
  EXPECT_EQ(LoadPreset("fetch-reach-drq").seed, 8);
  EXPECT_THAT(ListPresets(), Contains("fetch-reach-state"));
}

TEST(SharedData, AWordIsAPathOrAName) {
  const auto find = [](const std::string& word) {
    return FindFileOrSharedData("presets", "preset", word);
  };
  EXPECT_EQ(find("fetch-reach-drq"), *FindSharedData("presets", "fetch-reach-drq"));
  EXPECT_EQ(find("nowhere/x"), "nowhere/x");
  EXPECT_EQ(find("fetch-reach-drq.json"), "fetch-reach-drq.json") << "in the working folder";
  EXPECT_THAT(UsageMessage([&] { find("nope"); }),
              testing::AllOf(testing::StartsWith("no preset 'nope': expected a file (*.json) or "),
                             testing::HasSubstr("fetch-reach-drq")));
}

TEST(SharedData, NothingOutsideTheFoldersIsReached) {
  ASSERT_TRUE(FindSharedData("presets", "fetch-reach-drq"));
  EXPECT_FALSE(FindSharedData("presets", "../presets/fetch-reach-drq"));
  EXPECT_FALSE(FindSharedData("presets", ""));
}

}  // namespace
}  // namespace shoal
