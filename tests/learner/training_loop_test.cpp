// SPDX-License-Identifier: Apache-2.0
#include "learner/training_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/learner/training_loop_fixture.h"

namespace shoal::learner {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;

TEST_F(TrainingLoopTest, EveryUpdateIsCountedForWhoeverComesAfterAKill) {
  Train(7);
  EXPECT_EQ(UpdatePage(folder_.path(), 5).lost(), 2u) << "had its newest checkpoint been the fifth";
}

TEST_F(TrainingLoopTest, SendsWeightsAtTheFirstUpdateAndEveryPeriod) {
  EXPECT_EQ(Train(12), TrainingLoop::End::kStopped);
  EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(1, 5, 10));
  EXPECT_EQ(sink_.weights[1].env_steps, 50u);
  const auto tensors = nn::ReadSafetensors(sink_.weights[1].payload, "weights");
  ASSERT_FALSE(tensors.empty());
  for (const auto& [name, tensor] : tensors) EXPECT_EQ(tensor.dtype, "F32") << name;
  EXPECT_NE(sink_.weights[1].payload, sink_.weights[2].payload);
}

TEST_F(TrainingLoopTest, SendsBf16WeightsWhenThatIsThePrecision) {
  // The products' precision does not matter to the loop; ask the agent for what any CPU has.
  const auto agent = MakeAgent(run_.config, run_.spec, nn::Precision::kF32);
  sink_.spec_hash = run_.spec.Hash();
  sink_.session = kTrainingSession;
  WeightsSender(run_, nn::Precision::kBf16, kTrainingSession, *agent, sink_).Send(0);
  ASSERT_EQ(sink_.weights.size(), 1u);
  for (const auto& [name, t] : nn::ReadSafetensors(sink_.weights[0].payload, "weights")) {
    EXPECT_EQ(t.dtype, "BF16") << name;
  }
}

TEST_F(TrainingLoopTest, AnOrderOfThreadsIsObeyedOnceBetweenTwoUpdates) {
  std::vector<int> orders;
  resize_ = [&](int threads) {
    orders.push_back(threads);
    return threads == 3 ? 3 : 1;  // 9 does not fit: as before
  };
  Train(16, [&](PlayedBatches& batches) {
    batches.before = [this](uint64_t request) {
      if (request > 16) return Say(RunState::kStopping);
      if (request >= 3) Set("learner.threads", request < 9 ? 3 : 9);
    };
  });
  EXPECT_THAT(orders, ElementsAre(3, 9)) << "not asked again for each batch";
  EXPECT_EQ(Figure("threads"), 1);
}

TEST_F(TrainingLoopTest, WithoutBatchesNothingIsSentOrWritten) {
  Train(0);
  EXPECT_TRUE(sink_.weights.empty());
  EXPECT_TRUE(Checkpoints().empty());
}

TEST_F(TrainingLoopTest, ALearnerThatResumedSendsItsWeightsAtOnce) {
  Train(7);
  const auto before = sink_.weights.size();
  Say(RunState::kRunning);
  Train(7);
  ASSERT_EQ(sink_.weights.size(), before + 1);
  EXPECT_EQ(sink_.weights.back().update, 7u);
  EXPECT_EQ(sink_.weights.back().env_steps, 70u);
}

TEST_F(TrainingLoopTest, WeightsThatWereNotTakenAreFollowedByNewerOnes) {
  sink_.accept_weights = false;
  Train(8, [&](PlayedBatches& batches) {
    batches.before = [this](uint64_t request) {
      if (request == 8) sink_.accept_weights = true;
      if (request > 8) Say(RunState::kStopping);
    };
  });
  EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(8));
}

TEST_F(TrainingLoopTest, SlowReadersAreNotOverrun) {
  sink_.readers_keep_up = false;
  Train(30, [&](PlayedBatches& batches) {
    batches.before = [this](uint64_t request) {
      if (request == 28) sink_.readers_keep_up = true;
      if (request > 30) Say(RunState::kStopping);
    };
  });
  const auto updates = sink_.Updates(sink_.weights);
  // Without readers only patience would send more, and the thirty updates are done well within it.
  EXPECT_THAT(updates, ElementsAre(1, 28, 30));
}

TEST_F(TrainingLoopTest, MakesAnEvaluationPointAtEachMultipleOfTheInterval) {
  run_.config.eval.interval = 40;  // ten steps per batch
  Train(10);
  EXPECT_THAT(sink_.Updates(sink_.evaluations), ElementsAre(4, 8));
  for (const auto& sent : sink_.evaluations) {
    EXPECT_EQ(sent.checkpoint, CheckpointName(sent.update));
    EXPECT_EQ(sent.env_steps, 10 * sent.update);
    const fs::path folder = Checkpoint(sent.checkpoint);
    EXPECT_EQ(ReadCheckpoint(folder, run_.spec.Hash()).state.env_steps, sent.env_steps);
    const auto evaluated = nn::ReadSafetensors(sent.payload, "evaluation");
    const auto stored = nn::ReadSafetensors(ReadFile(folder / "policy.safetensors"), "policy");
    ASSERT_EQ(evaluated.size(), stored.size());
    for (const auto& [name, tensor] : evaluated) {
      EXPECT_EQ(tensor.dtype, "F32");
      EXPECT_EQ(tensor.data, stored.at(name).data) << name;
    }
  }
}

TEST_F(TrainingLoopTest, SeveralMultiplesPassedAtOnceAreOnePoint) {
  run_.config.eval.interval = 30;
  Train(3, [](PlayedBatches& batches) {
    batches.stored_steps = [](uint64_t request) { return 100 + request; };
  });
  EXPECT_THAT(sink_.Updates(sink_.evaluations), ElementsAre(1));
}

TEST_F(TrainingLoopTest, AnUnsentEvaluationPointIsSentAgain) {
  run_.config.eval.interval = 40;
  sink_.reject_evaluations = 2;
  Train(7);
  EXPECT_THAT(sink_.Updates(sink_.evaluations), ElementsAre(4));
  EXPECT_EQ(sink_.evaluations[0].checkpoint, "step_000000004");
  EXPECT_EQ(sink_.evaluations[0].env_steps, 40u);
}

TEST_F(TrainingLoopTest, KeepsCheckpointsThatWaitForTheirEvaluation) {
  run_.config.eval.interval = 20;
  run_.config.learner.checkpoint_period = 1;
  Train(9, [&](PlayedBatches& batches) {
    batches.before = [this](uint64_t request) {
      if (request == 8) pending_.OnEvaluated(4);  // 2 was passed over
      if (request > 9) Say(RunState::kStopping);
    };
  });
  EXPECT_THAT(Checkpoints(), ElementsAre("step_000000004", "step_000000006", "step_000000007",
                                         "step_000000008", "step_000000009"));
}

TEST_F(TrainingLoopTest, WritesCheckpointsEveryPeriodAndAtTheEnd) {
  run_.config.learner.checkpoint_period = 4;
  Train(9);
  EXPECT_THAT(Checkpoints(), ElementsAre("step_000000004", "step_000000008", "step_000000009"));
  const CheckpointState state =
      ReadCheckpoint(Checkpoint("step_000000009"), run_.spec.Hash()).state;
  EXPECT_EQ(state.updates, 9u);
  EXPECT_EQ(state.env_steps, 90u);
  EXPECT_EQ(state.request, 9u);
  EXPECT_EQ(state.learner_session, kTrainingSession);
  EXPECT_EQ(state.precision, "f32");
}

TEST_F(TrainingLoopTest, ARunInTwoPartsEndsWithTheSameBytes) {
  Train(10);
  const std::string whole = ReadFile(Checkpoint("step_000000010") / "learner.safetensors");
  fs::remove_all(folder_.path() / "checkpoints");
  Say(RunState::kRunning);
  Train(6);
  Say(RunState::kRunning);
  Train(10);
  EXPECT_TRUE(ReadFile(Checkpoint("step_000000010") / "learner.safetensors") == whole);
}

TEST_F(TrainingLoopTest, ANonFiniteUpdateEndsTheRunAndKeepsTheLastGoodCheckpoint) {
  run_.config.learner.checkpoint_period = 4;
  try {
    Train(100, [](PlayedBatches& batches) { batches.poisoned_request = 7; });
    FAIL() << "trained on not-a-number";
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), static_cast<int>(ErrorKind::kNonFinite));
    EXPECT_THAT(e.what(), testing::HasSubstr("update 7 is not finite"));
    EXPECT_THAT(e.what(), testing::HasSubstr("step_000000004"));
  }
  EXPECT_THAT(Checkpoints(), ElementsAre("step_000000004"));
  EXPECT_EQ(ReadCheckpoint(Checkpoint("step_000000004"), run_.spec.Hash()).state.updates, 4u);
}

TEST_F(TrainingLoopTest, WithoutACoordinatorItWritesACheckpointAndLeaves) {
  run_.config.learner.checkpoint_period = 1000;
  const TrainingLoop::End end = Train(1000, [&](PlayedBatches& batches) {
    batches.before = [this](uint64_t request) {
      if (request != 4) return;
      const SteadyTime heard = Now() - ControlState::kLease - seconds(1);
      control_.OnMessage({.epoch = ++epoch_}, heard);
      for (int i = 0; i <= 32; ++i) control_.CoordinatorLost(heard + i * milliseconds(500));
    };
  });
  EXPECT_EQ(end, TrainingLoop::End::kCoordinatorLost);
  EXPECT_THAT(Checkpoints(), ElementsAre("step_000000004"));
}

TEST_F(TrainingLoopTest, InLockstepSendsWeightsAtTheEndsOfPhasesOnly) {
  run_.config.lockstep = true;
  run_.config.envs_per_actor = 2;
  run_.config.lockstep_steps = 6;  // 12 steps, 3 updates per phase
  sink_.readers_keep_up = false;
  Train(10);
  EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(3, 6, 9));
}

TEST_F(TrainingLoopTest, TellsItsProgressWithTheEvaluationsItAskedFor) {
  run_.config.eval.interval = 20;
  Train(5);
  ASSERT_FALSE(sink_.progress.empty());
  const LearnerProgress& last = sink_.progress.back();
  EXPECT_EQ(last.session, kTrainingSession);
  EXPECT_EQ(last.updates, 5u);
  EXPECT_EQ(last.env_steps, 50u);
  EXPECT_FALSE(last.drained);
  ASSERT_EQ(last.evaluations.size(), sink_.evaluations.size());
  for (size_t i = 0; i < last.evaluations.size(); ++i) {
    EXPECT_EQ(last.evaluations[i].update, sink_.evaluations[i].update);
    EXPECT_EQ(last.evaluations[i].env_steps, sink_.evaluations[i].env_steps);
    EXPECT_EQ(last.evaluations[i].checkpoint, sink_.evaluations[i].checkpoint);
  }
}

TEST_F(TrainingLoopTest, ReportsWhatItDid) {
  Train(5);
  ASSERT_FALSE(sink_.reports.empty());
  const MetricsMessage& last = sink_.reports.back();
  EXPECT_EQ(last.role, "learner");
  EXPECT_EQ(last.state, "stopping");
  EXPECT_EQ(Figure("updates"), 5);
  EXPECT_EQ(Figure("env_steps"), 50);
  EXPECT_EQ(Figure("weights_sent"), 2);
  EXPECT_EQ(Figure("checkpoints"), 1);
  EXPECT_GT(Figure("critic_loss"), 0);
  EXPECT_GT(Figure("temperature"), 0);
  EXPECT_EQ(Figure("data_age_updates_p99"), 5);
  EXPECT_GT(Figure("seconds_forward"), 0);
  EXPECT_EQ(last.names.size(), last.values.size());
}

}  // namespace
}  // namespace shoal::learner
