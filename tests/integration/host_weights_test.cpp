// SPDX-License-Identifier: Apache-2.0
// Weights in a run of the real processes: one actor of a host receives them. If this actor is
// killed or stopped, the other actors still get new weights.
#include <gtest/gtest.h>

#include <csignal>

#include "tests/support/running_training.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;

constexpr int kActors = 3;

TrainingRun::Keys WeightsKeys() {
  return {{"actors", std::to_string(kActors)},
          {"env_steps", "2000000"},
          {"eval.final_episodes", "0"},
          {"eval.interval", "2000000"},
          {"replay.samples_per_insert", "2"}};
}

// Waits until each actor acts with a version after `update`. Returns the actors that receive
// weights.
std::vector<int> ReceiversAfter(RunningTraining* training, double update) {
  std::vector<int> receivers;
  for (int actor = 0; actor < kActors; ++actor) {
    const json report = training->reports().WaitFor(
        "actor", [&](const json& r) { return r.value("weights_update", 0.0) > update; },
        seconds(60), actor);
    if (report.is_null()) {
      ADD_FAILURE() << "actor " << actor << " has no weights after update " << update;
      return {};
    }
    if (report.at("weights_receiver") == 1) receivers.push_back(actor);
  }
  return receivers;
}

double NewestUpdate(RunningTraining* training) {
  return training->reports().Await("learner").at("updates").get<double>();
}

pid_t PidOfActor(RunningTraining* training, int actor) {
  return training->reports().Await("actor", actor).at("pid").get<pid_t>();
}

class HostWeightsOfARun : public testing::Test {
 protected:
  HostWeightsOfARun() : training_(run_, run_.Command(WeightsKeys())) {}
  void TearDown() override {
    training_.Interrupt();
    EXPECT_EQ(training_.End(seconds(60)), kInterruptedExit) << training_.Output();
    ExpectBalanced(run_.Json("meta.json"));
  }

  const TrainingRun run_{};
  RunningTraining training_;
};

TEST_F(HostWeightsOfARun, OneActorReceivesAlsoWhenTheOneThatDidIsKilled) {
  const std::vector<int> receivers = ReceiversAfter(&training_, 0);
  ASSERT_EQ(receivers.size(), 1u) << training_.Output();
  const pid_t receiver = PidOfActor(&training_, receivers[0]);
  ASSERT_EQ(kill(receiver, SIGKILL), 0);
  ASSERT_FALSE(training_.reports()
                   .WaitFor(
                       "actor", [&](const json& r) { return r.at("pid") != receiver; }, seconds(60),
                       receivers[0])
                   .is_null());
  EXPECT_EQ(ReceiversAfter(&training_, NewestUpdate(&training_)).size(), 1u);
}

TEST_F(HostWeightsOfARun, TheOthersActOnWhileTheReceiverIsStopped) {
  const std::vector<int> receivers = ReceiversAfter(&training_, 0);
  ASSERT_EQ(receivers.size(), 1u) << training_.Output();
  const pid_t receiver = PidOfActor(&training_, receivers[0]);
  ASSERT_EQ(kill(receiver, SIGSTOP), 0);
  for (int actor = 0; actor < kActors; ++actor) {
    if (actor == receivers[0]) continue;
    EXPECT_FALSE(training_.reports()
                     .WaitFor(
                         "actor", [](const json& r) { return r.at("weights_receiver") == 1; },
                         seconds(30), actor)
                     .is_null())
        << "actor " << actor;
  }
  ASSERT_EQ(kill(receiver, SIGCONT), 0);
  EXPECT_EQ(ReceiversAfter(&training_, NewestUpdate(&training_)).size(), size_t{kActors});
}

}  // namespace
}  // namespace shoal
