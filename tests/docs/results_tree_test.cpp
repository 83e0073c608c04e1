// SPDX-License-Identifier: Apache-2.0
// The size and the kinds of files in docs/results
// (docs/decisions/0024-large-evidence-is-kept-by-hash.md).
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/base/files.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

constexpr uintmax_t kMostBytes = 4'000'000;
constexpr std::ptrdiff_t kMostLines = 60;  // of a page about one experiment

std::ptrdiff_t LinesOf(const std::string& text) { return std::ranges::count(text, '\n'); }

bool ListsEpisodes(const std::string& text) {
  const json value = json::parse(text);
  return value.is_object() && value.contains("episodes") && value["episodes"].is_array();
}

// The fault of one file, or nothing.
std::string FaultOf(const fs::path& file) {
  const std::string kind = file.extension();
  if (kind == ".svg") return "";
  if (kind == ".md") {
    const std::ptrdiff_t lines = LinesOf(ReadFile(file));
    return lines > kMostLines ? fmt::format("{} lines, expected at most {}", lines, kMostLines)
                              : "";
  }
  if (kind != ".json") return "expected .md, .json or .svg";
  return ListsEpisodes(ReadFile(file)) ? "lists episodes: expected the aggregate alone" : "";
}

struct Look {
  uintmax_t bytes = 0;
  std::vector<std::string> faults;
};

Look LookAt(const fs::path& root) {
  Look look;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file()) continue;
    look.bytes += entry.file_size();
    const std::string fault = FaultOf(entry.path());
    if (fault.empty()) continue;
    look.faults.push_back(entry.path().lexically_relative(root).string() + ": " + fault);
  }
  return look;
}

constexpr char kHint[] =
    "python3 tests/comparison/evidence.py add FILE takes a file out of the tree and notes its hash";

TEST(ResultsTree, IsSmallAndHasNeitherReportsNorFilmsNorEpisodes) {
  const Look look = LookAt(SourcePath("docs/results"));
  EXPECT_LE(look.bytes, kMostBytes) << kHint;
  EXPECT_THAT(look.faults, IsEmpty()) << kHint;
}

TEST(ResultsTree, FaultsAreNamed) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& text) {
    WriteFileAtomically(folder.path() / name, text);
  };
  write("a.html", "x");
  write("b.json", R"({"episodes": [{"success": true}]})");
  write("c.json", R"({"episodes": 400})");
  write("d.md", std::string(61, '\n'));
  write("e.md", std::string(60, '\n'));
  const Look look = LookAt(folder.path());
  EXPECT_THAT(look.faults,
              UnorderedElementsAre("a.html: expected .md, .json or .svg",
                                   "b.json: lists episodes: expected the aggregate alone",
                                   "d.md: 61 lines, expected at most 60"));
  EXPECT_GT(look.bytes, 121u);
}

TEST(ResultsTree, EveryPageOfAnExperimentIsLinkedFromTheTable) {
  const std::string page = ReadFile(SourcePath("docs/results.md"));
  int pages = 0;
  for (const auto& entry : fs::directory_iterator(SourcePath("docs/results"))) {
    if (entry.path().extension() != ".md") continue;
    ++pages;
    EXPECT_THAT(page, HasSubstr("(results/" + entry.path().filename().string() + ")"));
  }
  EXPECT_GE(pages, 20);
}

// A file of the manifest is out of the tree; of an evaluation the tree has the aggregate.
TEST(ResultsTree, TheManifestNamesFilesThatAreOutOfTheTree) {
  const json manifest = json::parse(ReadFile(SourcePath("docs/results/evidence.json")));
  EXPECT_EQ(manifest["schema"], "shoal-evidence-1");
  EXPECT_GE(manifest["files"].size(), 100u);
  std::string before;
  for (const json& entry : manifest["files"]) {
    const auto path = entry["path"].get<std::string>();
    EXPECT_LT(before, path) << "sorted, each once";
    before = path;
    EXPECT_EQ(entry["sha256"].get<std::string>().size(), 64u) << path;
    EXPECT_GT(entry["bytes"].get<size_t>(), 0u) << path;
    const std::string file = SourcePath(path);
    if (!fs::exists(file)) continue;
    EXPECT_TRUE(path.ends_with(".json")) << path;
    EXPECT_LT(fs::file_size(file), entry["bytes"].get<size_t>()) << path;
  }
}

}  // namespace
}  // namespace shoal
