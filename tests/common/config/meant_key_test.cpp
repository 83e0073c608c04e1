// SPDX-License-Identifier: Apache-2.0
#include "common/config/meant_key.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "common/base/error.h"
#include "common/config/config_io.h"

namespace shoal {
namespace {

using ::testing::HasSubstr;

TEST(FindMeantKey, FindsAKeyByItsPathOrTheLastWordOfOnePathAlone) {
  for (const char* word : {"learner.batch", "batch", "learner-batch"}) {
    if (std::string(word) == "learner-batch") {
      EXPECT_EQ(FindMeantKey(word).key, "") << "a dot is no hyphen";
      continue;
    }
    EXPECT_EQ(FindMeantKey(word).key, "learner.batch");
    EXPECT_TRUE(FindMeantKey(word).same);
  }
  EXPECT_EQ(FindMeantKey("envs").key, "eval.envs");
  EXPECT_EQ(FindMeantKey("kind").key, "exploration.kind");
}

TEST(FindMeantKey, FindsTheNamesOfOtherPrograms) {
  const std::map<std::string, std::string> keys{{"lr", "learner.learning_rate"},
                                                {"batch_size", "learner.batch"},
                                                {"--batch-size", ""},
                                                {"batch-size", "learner.batch"},
                                                {"gamma", "learner.discount"},
                                                {"tau", "learner.tau"},
                                                {"buffer_size", "replay.capacity"},
                                                {"learning_starts", "replay.min_size"},
                                                {"total_timesteps", "env_steps"},
                                                {"total-timesteps", "env_steps"},
                                                {"algo", "learner.algorithm"},
                                                {"Env", "task"},
                                                {"learner.lr", "learner.learning_rate"}};
  for (const auto& [word, key] : keys) {
    EXPECT_EQ(FindMeantKey(word).key, key) << word;
    EXPECT_EQ(FindMeantKey(word).same, !key.empty()) << word;
  }
}

TEST(FindMeantKey, SaysWhereNoKeyHasTheSameMeaning) {
  EXPECT_EQ(FindMeantKey("n_envs").key, "envs_per_actor");
  EXPECT_FALSE(FindMeantKey("n_envs").same);
  EXPECT_THAT(FindMeantKey("n_envs").note, HasSubstr("each actor"));
  EXPECT_EQ(FindMeantKey("gpu").key, "");
  EXPECT_THAT(FindMeantKey("gpu").note, HasSubstr("learner.device=cuda"));
  EXPECT_EQ(FindMeantKey("warp_drive").key, "");
  EXPECT_EQ(FindMeantKey("warp_drive").note, "");
}

// The table names keys by text: each of them is taken for a key of ours.
TEST(FindMeantKey, OnlyNamesKeysThatThereAre) {
  for (const char* word :
       {"steps",          "env",         "name",          "log_dir",      "actors",
        "n_envs",         "frame_stack", "image_size",    "buffer_size",  "learning_starts",
        "train_freq",     "image_pad",   "nstep",         "her",          "n_sampled_goal",
        "algo",           "batch_size",  "n_threads",     "lr",           "actor_lr",
        "critic_lr",      "alpha_lr",    "gamma",         "policy_delay", "target_update_interval",
        "ent_coef",       "init_alpha",  "normalize",     "save_freq",    "n_steps",
        "n_epochs",       "clip_range",  "clip_range_vf", "vf_coef",      "action_noise",
        "start_steps",    "net_arch",    "features_dim",  "cnn",          "eval_freq",
        "n_eval_episodes"}) {
    const MeantKey meant = FindMeantKey(word);
    EXPECT_EQ(FindMeantKey(meant.key).key, meant.key) << word;
    EXPECT_NE(meant.key, "") << word;
  }
}

std::string AssignmentRefusal(const std::string& assignment) {
  Config config;
  try {
    ApplyAssignments({assignment}, &config);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(FindMeantKey, AnUnknownKeyIsRefusedWithTheOneThatIsMeant) {
  EXPECT_EQ(AssignmentRefusal("batch_size=512"),
            "--set: unknown key 'batch_size', it is called 'learner.batch' here");
  EXPECT_EQ(AssignmentRefusal("n_envs=8"),
            "--set: unknown key 'n_envs', nearest in meaning is 'envs_per_actor', which counts the "
            "environments of each actor, not of all");
  EXPECT_EQ(AssignmentRefusal("device=cuda"),
            "--set: unknown key 'device', it is called 'learner.device' here");
  EXPECT_EQ(AssignmentRefusal("gpus=1"),
            "--set: unknown key 'gpus', a GPU is chosen by learner.device=cuda");
  EXPECT_EQ(AssignmentRefusal("sed=1"), "--set: unknown key 'sed', nearest is 'seed'");
}

}  // namespace
}  // namespace shoal
