// SPDX-License-Identifier: Apache-2.0
// An installation in a temporary folder, shared by the tests of a suite.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "tests/support/paths.h"
#include "tests/support/program.h"

namespace shoal {

class InstalledShoal : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    const std::filesystem::path build =
        std::filesystem::path(ProgramPath("shoal")).parent_path().parent_path();
    Expect(RunIn(Folder(), "cmake --install " + build.string() + " --prefix " + Prefix().string()));
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::filesystem::path Folder() { return folder_->path(); }
  static std::filesystem::path Prefix() { return Folder() / "prefix"; }
  static std::string Shoal() { return (Prefix() / "bin/shoal").string(); }

  // Runs the shell command `line` in `folder`.
  static ProgramResult RunIn(const std::filesystem::path& folder, const std::string& line) {
    return RunCommand({"/bin/sh", "-c", "cd " + folder.string() + " && " + line},
                      std::chrono::seconds(400));
  }
  static void Expect(const ProgramResult& result) {
    ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  }

 private:
  static inline std::unique_ptr<TemporaryFolder> folder_;
};

}  // namespace shoal
