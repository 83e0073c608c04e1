// SPDX-License-Identifier: Apache-2.0
#include "launch/record/evaluation_seed.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/config/run_files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

int64_t SeedOf(const std::filesystem::path& run, const std::vector<std::string>& keys) {
  RunConfig config;
  ApplyAssignments(keys, &config.config);
  WriteRunConfig(run, config);
  return OwnEvaluationSeed(run);
}

TEST(OwnEvaluationSeed, IsOfTheRunItsSeedAndItsRecipe) {
  const TemporaryFolder folder;
  const int64_t seed = SeedOf(folder.path(), {"run_name=a", "seed=1"});
  EXPECT_EQ(SeedOf(folder.path(), {"run_name=a", "seed=1"}), seed) << "the same run, again";
  EXPECT_NE(SeedOf(folder.path(), {"run_name=b", "seed=1"}), seed);
  EXPECT_NE(SeedOf(folder.path(), {"run_name=a", "seed=2"}), seed);
  EXPECT_NE(SeedOf(folder.path(), {"run_name=a", "seed=1", "learner.batch=64"}), seed)
      << "another recipe under the same name";
}

TEST(OwnEvaluationSeed, IsNoneThatPeopleUse) {
  const TemporaryFolder folder;
  for (int run = 0; run < 20; ++run) {
    const int64_t seed = SeedOf(folder.path(), {fmt::format("seed={}", run)});
    EXPECT_GE(seed, 1'000'000'000);
    EXPECT_LT(seed, 2'000'000'000);
  }
  EXPECT_LT(kReservedEvaluationSeed, 1'000'000'000);
}

TEST(OwnEvaluationSeed, WantsARun) {
  const TemporaryFolder folder;
  EXPECT_THROW(OwnEvaluationSeed(folder.path()), Error);
}

}  // namespace
}  // namespace shoal::launch
