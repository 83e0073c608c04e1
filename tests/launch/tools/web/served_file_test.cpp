// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/served_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

class RunWithFiles {
 public:
  RunWithFiles() {
    Write("config.json", "{}");
    Write("report.html", "<p>");
    Write("videos/best.mp4", "film");
    Write("plots/curves.svg", "<svg/>");
    Write("../secret.mp4", "secret");
    Write("checkpoints/policy.mp4", "no film");
    Write("plots/.svg", "hidden");
    Write(".html", "hidden");
  }
  void Write(const std::string& file, const std::string& text) const {
    fs::create_directories((path() / file).parent_path());
    std::ofstream(path() / file) << text;
  }
  fs::path path() const { return folder_.path() / "run"; }

 private:
  TemporaryFolder folder_;
};

std::vector<std::string> Listed(const RunWithFiles& run) {
  std::vector<std::string> paths;
  for (const ServedName& name : ListServedFiles(run.path())) paths.push_back(name.path);
  return paths;
}

TEST(ServedFile, FilmsReportsAndPicturesAreServedWithTheirTypes) {
  const RunWithFiles run;
  const auto film = OpenServedFile(run.path(), "videos/best.mp4");
  ASSERT_TRUE(film);
  EXPECT_STREQ(film->type, "video/mp4");
  EXPECT_EQ(film->bytes, 4u);
  char content[4];
  EXPECT_EQ(read(film->file.get(), content, 4), 4);
  EXPECT_EQ(std::string(content, 4), "film");
  EXPECT_STREQ(OpenServedFile(run.path(), "report.html")->type, "text/html; charset=utf-8");
  EXPECT_THAT(Listed(run), ::testing::UnorderedElementsAre("videos/best.mp4", "report.html",
                                                           "plots/curves.svg"));
}

TEST(ServedFile, NothingElseOfTheFolderIs) {
  const RunWithFiles run;
  for (const char* path : {"config.json", "checkpoints/policy.mp4", "best.mp4", "videos/best.svg",
                           "videos", "videos/", "videos/other.mp4", "", ".", "..", "plots/.svg",
                           ".html", "videos/best.mp4/", "videos//best.mp4", "./report.html"}) {
    EXPECT_FALSE(OpenServedFile(run.path(), path)) << path;
  }
}

TEST(ServedFile, NoPathLeadsOutOfTheFolder) {
  const RunWithFiles run;
  for (const std::string& path :
       {std::string("../secret.mp4"), std::string("videos/../../secret.mp4"),
        std::string("videos/../best.mp4"), (run.path() / "videos/best.mp4").string(),
        std::string("videos/..\\secret.mp4"), std::string("videos/best.mp4\0.mp4", 20)}) {
    EXPECT_FALSE(OpenServedFile(run.path(), path)) << path;
  }
}

TEST(ServedFile, LinksAreNotFollowed) {
  const RunWithFiles run;
  fs::create_symlink("../../secret.mp4", run.path() / "videos/link.mp4");
  EXPECT_FALSE(OpenServedFile(run.path(), "videos/link.mp4"));
  fs::create_symlink("best.mp4", run.path() / "videos/near.mp4");
  EXPECT_FALSE(OpenServedFile(run.path(), "videos/near.mp4"));
  const RunWithFiles other;
  fs::remove_all(other.path() / "videos");
  fs::create_directory_symlink(run.path() / "videos", other.path() / "videos");
  EXPECT_FALSE(OpenServedFile(other.path(), "videos/best.mp4"));
  EXPECT_THAT(Listed(run), ::testing::Not(::testing::Contains("videos/link.mp4")));
}

TEST(ServedFile, WhatIsNoPlainFileIsNotWaitedFor) {
  const RunWithFiles run;
  ASSERT_EQ(mkfifo((run.path() / "videos/pipe.mp4").c_str(), 0600), 0);
  fs::create_directory(run.path() / "videos/folder.mp4");
  EXPECT_FALSE(OpenServedFile(run.path(), "videos/pipe.mp4"));
  EXPECT_FALSE(OpenServedFile(run.path(), "videos/folder.mp4"));
}

TEST(ServedFile, TheListIsBounded) {
  const RunWithFiles run;
  for (int i = 0; i < 250; ++i) run.Write("videos/" + std::to_string(i) + ".mp4", "x");
  EXPECT_EQ(Listed(run).size(), 200u);
}

}  // namespace
}  // namespace shoal::launch
