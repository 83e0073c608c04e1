// SPDX-License-Identifier: Apache-2.0
#include "learner/checkpoint_store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/learner/training_fixture.h"
#include "tests/support/temporary_folder.h"

namespace shoal::learner {
namespace {

namespace fs = std::filesystem;

class CheckpointStoreTest : public testing::Test {
 protected:
  CheckpointStore& Open() { return store_.emplace(run_folder_.path(), run_); }

  std::string Write(uint64_t updates, const std::set<std::string>& wanted = {}) {
    const CheckpointState state{.updates = updates,
                                .config_hash = store_->config_hash(),
                                .spec_hash = run_.spec.Hash(),
                                .precision = "f32"};
    const nn::NamedTensor tensor{
        "F32", {2}, std::vector<uint8_t>(8, static_cast<uint8_t>(updates))};
    return store_->Write(state, {{"x", tensor}}, {{"x", tensor}}, wanted);
  }

  void Truncate(const std::string& name) {
    fs::resize_file(folder_ / name / "learner.safetensors", 20);
  }

  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      names.push_back(entry.path().filename());
    }
    std::ranges::sort(names);
    return names;
  }

  using Expected = std::vector<std::string>;

  const TemporaryFolder run_folder_;
  const RunConfig run_ = SmallRun();
  const fs::path folder_ = run_folder_.path() / "checkpoints";
  std::optional<CheckpointStore> store_;
};

TEST_F(CheckpointStoreTest, ANewRunHasNone) { EXPECT_FALSE(Open().RestoreNewest()); }

TEST_F(CheckpointStoreTest, KeepsTheNewestThreeAndWhatIsNotItsOwn) {
  Open();
  fs::create_directories(folder_ / "best");
  fs::create_directories(folder_ / ".best.tmp");
  for (uint64_t updates = 1; updates <= 6; ++updates) Write(updates);
  EXPECT_EQ(Names(),
            (Expected{".best.tmp", "best", "step_000000004", "step_000000005", "step_000000006"}));
}

TEST_F(CheckpointStoreTest, KeepsWhatAnEvaluationIsWaitedFor) {
  Open();
  EXPECT_EQ(Write(1), "step_000000001");
  for (uint64_t updates = 2; updates <= 6; ++updates) Write(updates, {"step_000000001"});
  EXPECT_EQ(Names(),
            (Expected{"step_000000001", "step_000000004", "step_000000005", "step_000000006"}));
  Write(7);
  EXPECT_EQ(Names(), (Expected{"step_000000005", "step_000000006", "step_000000007"}));
}

TEST_F(CheckpointStoreTest, RestoresTheNewestOne) {
  Open();
  for (const uint64_t updates : {9, 10, 100}) Write(updates);
  const auto checkpoint = Open().RestoreNewest();
  ASSERT_TRUE(checkpoint);
  EXPECT_EQ(checkpoint->state.updates, 100u);
  EXPECT_EQ(checkpoint->tensors.at("x").data[0], 100);
}

TEST_F(CheckpointStoreTest, SetsABrokenOneAsideAndTakesTheOneBefore) {
  Open();
  Write(1);
  Write(2);
  Truncate("step_000000002");
  const auto checkpoint = Open().RestoreNewest();
  ASSERT_TRUE(checkpoint);
  EXPECT_EQ(checkpoint->state.updates, 1u);
  EXPECT_EQ(Names(), (Expected{"refused_step_000000002", "step_000000001"}));
}

TEST_F(CheckpointStoreTest, DoesNotStartAfreshWhenNoneCanBeUsed) {
  Open();
  Write(1);
  Write(2);
  Truncate("step_000000001");
  Truncate("step_000000002");
  try {
    Open().RestoreNewest();
    FAIL() << "went on without its checkpoints";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("step_000000002/learner.safetensors"), std::string::npos)
        << e.what();
  }
  EXPECT_EQ(Names(), (Expected{"step_000000001", "step_000000002"})) << "left for a look";
}

TEST_F(CheckpointStoreTest, RemovesWhatAKilledLearnerLeftHalfWritten) {
  Open();
  fs::create_directories(folder_ / ".step_000000005.tmp-77");
  fs::create_directories(folder_ / ".step_000000001.old");
  std::ofstream(folder_ / ".step_000000005.tmp-77" / "learner.safetensors") << "half";
  Open();
  EXPECT_TRUE(Names().empty());
}

TEST_F(CheckpointStoreTest, SaysWhereACheckpointComesFrom) {
  Open();
  const auto meta = nlohmann::json::parse(ReadFile(folder_ / Write(3) / ".meta.json"));
  EXPECT_EQ(meta.at("schema"), "shoal-checkpoint-meta-1");
  EXPECT_EQ(meta.at("checkpoint"), "step_000000003");
  EXPECT_EQ(meta.at("run"), "small");
  EXPECT_EQ(meta.at("seed"), 1);
}

// Nothing can be made in a folder that is no folder.
TEST_F(CheckpointStoreTest, WhatCannotBeWrittenIsKeptAndWrittenLater) {
  Open();
  Write(1);
  const fs::path elsewhere = run_folder_.path() / "moved";
  fs::rename(folder_, elsewhere);
  WriteFileAtomically(folder_, "in the way");
  for (const uint64_t updates : {2, 3, 4}) Write(updates);
  EXPECT_EQ(store_->UnwrittenUpdates(), 4u);
  store_->Retry({}, /*now=*/true);
  EXPECT_EQ(store_->UnwrittenUpdates(), 4u);
  fs::remove(folder_);
  fs::rename(elsewhere, folder_);
  EXPECT_EQ(Names(), (Expected{"step_000000001"})) << "the last good one stays";
  EXPECT_EQ(store_->WrittenUpdates(), 1u);
  store_->Retry({});
  EXPECT_EQ(store_->UnwrittenUpdates(), 4u) << "not at once again";
  store_->Retry({}, /*now=*/true);
  EXPECT_FALSE(store_->UnwrittenUpdates());
  EXPECT_EQ(Names(), (Expected{"step_000000001", "step_000000003", "step_000000004"}))
      << "as many as are kept in memory";
}

}  // namespace
}  // namespace shoal::learner
