// SPDX-License-Identifier: Apache-2.0
#include "actor/loop/rollout_state.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::actor {
namespace {

class RolloutStateTest : public testing::Test {
 protected:
  RolloutStateTest() { MakeFolders(run_.path() / "made"); }

  const TemporaryFolder run_;
  const std::filesystem::path file_ = run_.path() / "made" / "actor-2.rollout";
  const RolloutState state_ = Example();

 private:
  static RolloutState Example() {
    RolloutState state{
        .session = 1'795'252'994'908'548'472, .made = 1234, .env_steps = 1200, .episodes = {}};
    EpisodeState& running = state.episodes.emplace_back();
    running.episode = 7;
    running.running = true;
    running.cut_after = 13;
    running.noise = {{1, ~uint64_t{0}, 3, 4}, {-0.0, 5e-324, 0.1}};
    running.actions = {0.1F, -1.0F, 1e-42F, 0.0F};
    state.episodes.emplace_back().episode = 8;
    return state;
  }
};

TEST_F(RolloutStateTest, IsTakenOnceBitForBit) {
  EXPECT_EQ(TakeRolloutState(run_.path(), 2), std::nullopt);
  WriteRolloutState(run_.path(), 2, state_);
  EXPECT_EQ(TakeRolloutState(run_.path(), 1), std::nullopt) << "another actor's";
  EXPECT_EQ(TakeRolloutState(run_.path(), 2), state_);
  EXPECT_EQ(TakeRolloutState(run_.path(), 2), std::nullopt) << "a killed successor leaves none";
}

TEST_F(RolloutStateTest, ADamagedFileIsRefusedByName) {
  WriteRolloutState(run_.path(), 2, state_);
  const std::string whole = ReadFile(file_);
  std::vector<std::string> damaged{"", whole.substr(0, whole.size() / 2)};
  for (size_t byte = 0; byte + 1 < whole.size(); ++byte) {
    damaged.push_back(whole);
    damaged.back()[byte] = static_cast<char>(whole[byte] ^ (1 << byte % 8));
  }
  for (const std::string& content : damaged) {
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << content;
    try {
      TakeRolloutState(run_.path(), 2);
      ADD_FAILURE() << "took " << content;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("actor-2.rollout"), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace shoal::actor
