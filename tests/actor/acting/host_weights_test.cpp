// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/host_weights.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "common/wire/weights_parts.h"
#include "tests/support/temporary_folder.h"

namespace shoal::actor {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr uint64_t kSpec = 5;

// An actor of a host, and what reaches it over the network.
class Actor {
 public:
  explicit Actor(const TemporaryFolder& run, const std::string& host = "here")
      : weights_(run.path(), host, kSpec, [this](WeightsInbox& inbox) {
          network_ = &inbox;
          return std::shared_ptr<void>(&network_,
                                       [](WeightsInbox** network) { *network = nullptr; });
        }) {}

  HostWeights& weights() { return weights_; }
  // False: it does not listen.
  bool Deliver(uint64_t update, const std::string& payload) {
    if (network_ == nullptr) return false;
    WeightsMessage message;
    message.spec_hash = kSpec;
    message.version = {1, update};
    message.payload = {reinterpret_cast<const uint8_t*>(payload.data()), payload.size()};
    for (uint32_t part = 0; part < WeightsParts(payload.size()); ++part) {
      network_->OnMessage(PartOf<WeightsPart>(message, part));
    }
    return true;
  }
  std::string Take() {
    const auto weights = weights_.TryTake();
    return weights ? std::string(weights->payload.view()) : "";
  }
  // Looks on until it receives.
  bool ComesToReceive(seconds deadline = seconds(20)) {
    const SteadyTime end = Now() + deadline;
    while (!weights_.receives() && Now() < end) {
      weights_.TryTake();
      std::this_thread::sleep_for(milliseconds(10));
    }
    return weights_.receives();
  }

 private:
  WeightsInbox* network_ = nullptr;
  HostWeights weights_;
};

class HostWeightsTest : public testing::Test {
 protected:
  HostWeightsTest() { std::filesystem::create_directory(run_.path() / "made"); }

  const TemporaryFolder run_;
};

TEST_F(HostWeightsTest, OneReceivesAndItsNeighboursReadTheSame) {
  Actor first(run_), second(run_), third(run_);
  for (Actor* actor : {&first, &second, &third}) EXPECT_EQ(actor->Take(), "");
  EXPECT_TRUE(first.weights().receives());
  EXPECT_FALSE(second.weights().receives() || third.weights().receives());
  ASSERT_TRUE(first.Deliver(1, "one"));
  EXPECT_EQ(second.Take(), "one");
  EXPECT_EQ(first.Take(), "one");
  EXPECT_EQ(second.Take(), "");
  ASSERT_TRUE(first.Deliver(2, "two"));
  EXPECT_EQ(second.Take(), "two");
  EXPECT_EQ(third.Take(), "two");
}

TEST_F(HostWeightsTest, EveryHostHasAReceiver) {
  Actor here(run_, "here"), there(run_, "there");
  here.Take();
  there.Take();
  EXPECT_TRUE(here.weights().receives() && there.weights().receives());
}

TEST_F(HostWeightsTest, WhenTheReceiverIsGoneANeighbourReceivesOn) {
  auto first = std::make_unique<Actor>(run_);
  Actor second(run_), third(run_);
  first->Take();
  second.Take();
  third.Take();
  first->Deliver(5, "five");
  EXPECT_EQ(second.Take(), "five");
  first.reset();
  ASSERT_TRUE(second.ComesToReceive());
  // The transport gives a late joiner the last version once more.
  second.Deliver(5, "five");
  EXPECT_EQ(second.Take(), "");
  EXPECT_FALSE(third.weights().receives());
  second.Deliver(6, "six");
  EXPECT_EQ(second.Take(), "six");
  const SteadyTime end = Now() + seconds(20);
  std::string read;
  while (read.empty() && Now() < end) read = third.Take();
  EXPECT_EQ(read, "six");
  EXPECT_FALSE(third.weights().receives());
}

TEST_F(HostWeightsTest, WhoCannotReadTheBoardReceivesAlone) {
  Actor first(run_), second(run_);
  first.Take();
  std::ofstream(run_.path() / "made" / "weights-here.json") << R"({"pid": 1, "descriptor": 0})";
  const SteadyTime start = Now();
  ASSERT_TRUE(second.ComesToReceive());
  EXPECT_GE(Now() - start, HostWeights::kPatience);
  EXPECT_TRUE(second.Deliver(1, "one"));
  EXPECT_EQ(second.Take(), "one");
}

TEST_F(HostWeightsTest, AStoppedReceiverIsNotWaitedFor) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t holder = fork();
  if (holder == 0) {
    Actor stopped(run_);
    stopped.Take();
    stopped.Deliver(1, "one");
    if (write(ready[1], "r", 1) != 1) _exit(1);
    while (true) pause();
  }
  char word = 0;
  ASSERT_EQ(read(ready[0], &word, 1), 1);
  Actor neighbour(run_);
  EXPECT_EQ(neighbour.Take(), "one");
  ASSERT_EQ(kill(holder, SIGSTOP), 0);
  EXPECT_TRUE(neighbour.ComesToReceive());
  kill(holder, SIGKILL);
  waitpid(holder, nullptr, 0);
  close(ready[0]);
  close(ready[1]);
}

// The receive thread posts while a neighbour's loop reads.
TEST_F(HostWeightsTest, VersionsAreReadWholeWhileOthersArePosted) {
  Actor first(run_), second(run_);
  first.Take();
  second.Take();
  constexpr uint64_t kVersions = 300;
  const auto content = [](uint64_t update) {
    return std::string(20'000 + update, char('a' + update % 26));
  };
  std::thread network([&] {
    for (uint64_t update = 1; update <= kVersions; ++update) first.Deliver(update, content(update));
  });
  uint64_t newest = 0, taken = 0;
  const SteadyTime end = Now() + seconds(60);
  while (newest < kVersions && Now() < end) {
    first.Take();
    const auto weights = second.weights().TryTake();
    if (!weights) continue;
    ++taken;
    EXPECT_GT(weights->version.update, newest);
    newest = weights->version.update;
    ASSERT_EQ(weights->payload.view(), content(newest));
  }
  network.join();
  EXPECT_EQ(newest, kVersions);
  EXPECT_GT(taken, 0u);
}

}  // namespace
}  // namespace shoal::actor
