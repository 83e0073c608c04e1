// SPDX-License-Identifier: Apache-2.0
// Episode k of environment i has the same bytes for every distribution of environments over actors
// and processes if each environment has its own stream of actions.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "actor/worlds/environment.h"
#include "common/base/random.h"

namespace shoal::worlds {
namespace {

constexpr uint64_t kSeed = 5;
constexpr int kEnvironments = 4, kEpisodes = 2, kSteps = 6;

// Hash of all bytes of an episode by (environment, episode).
using Hashes = std::map<std::pair<int, int>, uint64_t>;

Config ConfigOf(const std::string& task) {
  Config config;
  config.task = task;
  config.observation.height = config.observation.width = 32;
  config.observation.proprioception = true;
  if (task == "CustomHopper-source") {
    config.observation.cameras = {"track", "free"};
    config.randomization.body_mass = {{"thigh", {3.43, 4.43}}, {"leg", {2.21, 3.21}}};
  } else if (task == "walker_walk") {
    config.observation.cameras = {"side"};
  } else {
    config.observation.goal_mode = "both";
  }
  return config;
}

class Player {
 public:
  Player(const Config& config, std::shared_ptr<RenderContext> render, int number)
      : number_(number),
        environment_(MakeEnvironment(config, std::move(render))),
        frame_(static_cast<size_t>(environment_->spec().FrameBytes())),
        vector_(static_cast<size_t>(environment_->spec().RecordedVectorSize())) {}

  void Begin(int episode) {
    const auto env = static_cast<uint64_t>(number_), k = static_cast<uint64_t>(episode);
    environment_->Reset(StreamKey(kSeed, StreamRole::kTrainEnvironment, env, k), {frame_, vector_});
    actions_ = Random(StreamKey(kSeed, StreamRole::kTrainPolicy, env, k));
    hash_ = 0;
    Count(0);
  }
  void Step() {
    std::vector<float> action(static_cast<size_t>(environment_->spec().action_size));
    for (float& component : action) component = static_cast<float>(actions_.Uniform(-1, 1));
    Count(environment_->Step(action, {frame_, vector_}).reward);
  }
  int number() const { return number_; }
  uint64_t hash() const { return hash_; }

 private:
  void Count(float reward) {
    hash_ = HashWords({hash_, HashBytes(frame_.data(), frame_.size()),
                       HashBytes(vector_.data(), vector_.size() * sizeof(float)),
                       HashBytes(&reward, sizeof(reward))});
  }

  int number_;
  std::unique_ptr<Environment> environment_;
  std::vector<uint8_t> frame_;
  std::vector<float> vector_;
  Random actions_{0};
  uint64_t hash_ = 0;
};

// One actor with these environments, stepped in turn.
void PlayActor(const std::string& task, const std::vector<int>& numbers, Hashes* hashes) {
  const Config config = ConfigOf(task);
  const std::shared_ptr<RenderContext> render = MakeRenderContext(config.observation);
  std::vector<Player> players;
  players.reserve(numbers.size());
  for (const int number : numbers) players.emplace_back(config, render, number);
  for (int episode = 0; episode < kEpisodes; ++episode) {
    for (Player& player : players) player.Begin(episode);
    for (int step = 0; step < kSteps; ++step) {
      for (Player& player : players) player.Step();
    }
    for (Player& player : players) (*hashes)[{player.number(), episode}] = player.hash();
  }
}

// The same in a separate process, forked before this process draws numbers.
Hashes PlayInAnotherProcess(const std::string& task, const std::vector<int>& numbers) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    Hashes hashes;
    PlayActor(task, numbers, &hashes);
    for (const auto& [key, hash] : hashes) {
      if (write(ends[1], &hash, sizeof(hash)) != sizeof(hash)) _exit(1);
    }
    _exit(0);
  }
  close(ends[1]);
  Hashes hashes;
  for (const int number : numbers) {
    for (int episode = 0; episode < kEpisodes; ++episode) {
      uint64_t hash = 0;
      EXPECT_EQ(read(ends[0], &hash, sizeof(hash)), ssize_t{sizeof(hash)});
      hashes[{number, episode}] = hash;
    }
  }
  close(ends[0]);
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  return hashes;
}

class SpreadEnvironments : public testing::TestWithParam<const char*> {};

TEST_P(SpreadEnvironments, EpisodesDoNotDependOnActorsOrProcesses) {
  const std::string task = GetParam();
  const Hashes elsewhere = PlayInAnotherProcess(task, {0, 1, 2, 3});
  ASSERT_EQ(elsewhere.size(), size_t{kEnvironments * kEpisodes});
  Hashes here;
  for (const std::vector<int>& actor : {std::vector{2}, {3, 1, 0}}) PlayActor(task, actor, &here);
  EXPECT_EQ(here, elsewhere);
  // Not all the same for a reason that has nothing to do with it.
  std::map<uint64_t, int> different;
  for (const auto& [key, hash] : elsewhere) ++different[hash];
  EXPECT_EQ(different.size(), elsewhere.size());
}

INSTANTIATE_TEST_SUITE_P(Tasks, SpreadEnvironments,
                         testing::Values("FetchReach", "FetchPush", "FetchSlide",
                                         "FetchPickAndPlace", "CustomHopper-source",
                                         "walker_walk"));

}  // namespace
}  // namespace shoal::worlds
