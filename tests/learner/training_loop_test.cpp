// SPDX-License-Identifier: Apache-2.0
#include "learner/training_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <tuple>
#include <utility>
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

// Weights, checkpoints and evaluation points have the bytes of their updates.
TEST_F(TrainingLoopTest, ARunWithUpdatesInFlightSendsAndWritesTheSameBytes) {
  run_.config.learner.checkpoint_period = 3;
  run_.config.eval.interval = 40;  // four updates
  const auto train = [&](size_t delay) {
    delay_ = delay;
    Say(RunState::kRunning);
    Train(11);
    std::map<std::string, std::string> written;
    for (const std::string& name : Checkpoints()) {
      written[name] = ReadFile(Checkpoint(name) / "learner.safetensors");
    }
    fs::remove_all(folder_.path() / "checkpoints");
    EXPECT_EQ(TakeCounted(), 11u);
    EXPECT_EQ(Figure("updates"), 11);
    return std::tuple(written, std::exchange(sink_.weights, {}),
                      std::exchange(sink_.evaluations, {}));
  };
  const auto [written, weights, evaluations] = train(0);
  const auto [late_written, late_weights, late_evaluations] = train(3);
  EXPECT_GE(written.size(), 3u);
  EXPECT_EQ(late_written, written);
  const auto expect_same = [](const auto& sent, const auto& expected) {
    ASSERT_EQ(sent.size(), expected.size());
    ASSERT_FALSE(sent.empty());
    for (size_t i = 0; i < sent.size(); ++i) {
      EXPECT_EQ(sent[i].update, expected[i].update);
      EXPECT_EQ(sent[i].env_steps, expected[i].env_steps);
      EXPECT_TRUE(sent[i].payload == expected[i].payload) << sent[i].update;
    }
  };
  expect_same(late_weights, weights);
  expect_same(late_evaluations, evaluations);
}

// The outcome of update 1 is known when update 4 was submitted. Until then the learner trains on.
TEST_F(TrainingLoopTest, UpdatesContinueWhileWeightsAreOnTheirWay) {
  delay_ = 3;
  std::map<uint64_t, uint64_t> asked;  // the first request after the weights of each update
  Train(12, [&](PlayedBatches& batches) {
    batches.before = [&](uint64_t request) {
      for (const auto& sent : sink_.weights) asked.try_emplace(sent.update, request);
      if (request > 12) Say(RunState::kStopping);
    };
  });
  EXPECT_THAT(asked, ElementsAre(std::pair(1, 5), std::pair(5, 9)));
  EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(1, 5, 10)) << "the last ones at the end";
}

TEST_F(TrainingLoopTest, WeightsThatAreDueWaitForThoseOnTheirWay) {
  run_.config.learner.weights_period = 1;
  Train(11);
  const std::vector<KeptMessages::Sent> all = std::exchange(sink_.weights, {});
  ASSERT_EQ(all.size(), 11u);
  fs::remove_all(folder_.path() / "checkpoints");
  delay_ = 3;
  Say(RunState::kRunning);
  Train(11);
  EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(1, 4, 7, 10));
  for (const auto& sent : sink_.weights) {
    EXPECT_TRUE(sent.payload == all[sent.update - 1].payload) << sent.update;
    EXPECT_EQ(sent.env_steps, 10 * sent.update);
  }
  EXPECT_EQ(Figure("weights_sent"), 4);
}

// Update 7 is not finite, and the checkpoint, the weights or the evaluation point of update 8 are
// due before its outcome is known otherwise. Only weights let updates continue until it is known.
TEST_F(TrainingLoopTest, NothingLeavesBeforeTheOutcomesOfItsUpdatesAreKnown) {
  const RunConfig plain = run_;
  delay_ = 3;
  const std::pair<std::function<void()>, uint64_t> dues[] = {
      {[this] { run_.config.learner.checkpoint_period = 4; }, 8},
      {[this] { run_.config.learner.weights_period = 8; }, 10},
      {[this] { run_.config.eval.interval = 80; }, 8},
  };
  for (const auto& [due, last] : dues) {
    run_ = plain;
    run_.config.learner.weights_period = 100;
    due();
    uint64_t asked = 0;
    try {
      Train(100, [&](PlayedBatches& batches) {
        batches.poisoned_request = 7;
        batches.before = [&](uint64_t request) { asked = request; };
      });
      FAIL() << "trained on not-a-number";
    } catch (const Error& e) {
      EXPECT_EQ(e.exit_code(), static_cast<int>(ErrorKind::kNonFinite));
      EXPECT_THAT(e.what(), testing::HasSubstr("update 7 is not finite"));
    }
    EXPECT_EQ(asked, last);
    EXPECT_FALSE(Checkpoints().contains("step_000000008"));
    EXPECT_THAT(sink_.Updates(sink_.weights), ElementsAre(1));
    EXPECT_THAT(sink_.evaluations, testing::IsEmpty());
    EXPECT_EQ(TakeCounted(), 6u);
    fs::remove_all(folder_.path() / "checkpoints");
    sink_.weights.clear();
  }
}

TEST_F(TrainingLoopTest, AnIdleLearnerReportsEveryUpdateAndSendsItsWeights) {
  delay_ = 3;
  uint64_t counted = 0;
  size_t sent = 0;
  Train(2, [&](PlayedBatches& batches) {
    batches.last_request = 2;
    int turns = 0;
    batches.before = [&, turns](uint64_t) mutable {
      if (++turns <= 4) return;  // two batches and two turns without one
      counted = TakeCounted();
      sent = sink_.weights.size();
      Say(RunState::kStopping);
    };
  });
  EXPECT_EQ(counted, 2u);
  EXPECT_EQ(sent, 1u);
}

TEST_F(TrainingLoopTest, DrainingEndsWithTheUpdatesThatTheStoredStepsGrant) {
  // 48 steps are stored when draining begins: (48 - 8) * 1 samples are granted, 10 batches of 4.
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  Train(1000, [&](PlayedBatches& batches) {
    batches.stored_steps = [](uint64_t request) { return request < 3 ? 12 * request : 48; };
    batches.before = [this](uint64_t request) {
      if (request == 3) Say(RunState::kDraining);
    };
  });
  EXPECT_EQ(updates_, 10u);
  EXPECT_THAT(sink_.Updates(sink_.evaluations), ElementsAre(10));
  EXPECT_TRUE(Checkpoints().contains("step_000000010"));
}

// 12 of the 48 stored steps cannot be sampled: (36 - 8) * 1 samples, 7 batches of 4.
TEST_F(TrainingLoopTest, DrainingGrantsNothingForStepsThatNoSampleBeginsWith) {
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  Train(1000, [&](PlayedBatches& batches) {
    batches.unsampleable_steps = 12;
    batches.stored_steps = [](uint64_t request) { return request < 3 ? 12 * request : 48; };
    batches.before = [this](uint64_t request) {
      if (request == 3) Say(RunState::kDraining);
    };
  });
  EXPECT_EQ(updates_, 7u);
}

// Steps 8 to 48 of a line from 3 at step 0 to 1 at step 40: 32 (2.6 + 1) / 2 + 8 = 65.6 samples are
// granted, 17 batches of 4.
TEST_F(TrainingLoopTest, DrainingEndsWithTheUpdatesThatAScheduleGrants) {
  run_.config.replay.samples_per_insert = Schedule{3, 1, 40};
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  Train(1000, [&](PlayedBatches& batches) {
    batches.stored_steps = [](uint64_t request) { return request < 3 ? 12 * request : 48; };
    batches.before = [this](uint64_t request) {
      if (request == 3) Say(RunState::kDraining);
    };
  });
  EXPECT_EQ(updates_, 17u);
  EXPECT_EQ(Figure("samples_per_insert"), 1);
}

TEST_F(TrainingLoopTest, AResumedLearnerDrainsByTheWholeSchedule) {
  run_.config.replay.samples_per_insert = Schedule{3, 1, 40};
  const auto stored = [](uint64_t request) { return std::min<uint64_t>(6 * request, 48); };
  Train(4, [&](PlayedBatches& batches) { batches.stored_steps = stored; });
  ASSERT_EQ(updates_, 4u);
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  Say(RunState::kRunning);
  Train(1000, [&](PlayedBatches& batches) {
    batches.stored_steps = stored;
    batches.before = [this](uint64_t request) {
      if (request == 9) Say(RunState::kDraining);
    };
  });
  EXPECT_EQ(updates_, 17u);
}

// At step 28 the number 0.6 takes the schedule's place: 20 (2.6 + 1.6) / 2 + 20 * 0.6 = 54 samples.
TEST_F(TrainingLoopTest, WhatIsSetTakesTheSchedulesPlaceFromThereOn) {
  run_.config.replay.samples_per_insert = Schedule{3, 1, 40};
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  const auto say = [this](RunState state) {
    control_.OnMessage({.epoch = ++epoch_,
                        .state = state,
                        .time = 0,
                        .setting_names = {"replay.samples_per_insert"},
                        .setting_values = {0.6}},
                       Now());
  };
  Train(1000, [&](PlayedBatches& batches) {
    batches.stored_steps = [](uint64_t request) {
      return request < 4 ? std::min<uint64_t>(14 * request, 28) : 48;
    };
    batches.before = [&](uint64_t request) {
      if (request == 3) say(RunState::kRunning);
      if (request == 5) say(RunState::kDraining);
    };
  });
  EXPECT_EQ(updates_, 14u);
}

TEST_F(TrainingLoopTest, DrainingEndsWhenNoMoreBatchesCome) {
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  Train(6, [&](PlayedBatches& batches) {
    batches.before = [this](uint64_t request) {
      if (request == 5) Say(RunState::kDraining);
    };
  });
  EXPECT_THAT(sink_.Updates(sink_.evaluations), ElementsAre(6));
}

TEST_F(TrainingLoopTest, ADrainedLearnerTrainsNoMoreAndSaysSo) {
  run_.config.replay.samples_per_insert =
      Schedule::Constant(0);     // no limit: three more batches report stored records
  sink_.reject_evaluations = 2;  // sent in the second pass after draining was over
  sink_.on_evaluation = [this] { Say(RunState::kStopping); };
  Train(1000, [&](PlayedBatches& batches) {
    batches.before = [this](uint64_t request) {
      if (request == 5) Say(RunState::kDraining);
    };
  });
  EXPECT_EQ(given_, 8u) << "the one being waited for when draining began, and three more";
  EXPECT_THAT(sink_.Updates(sink_.evaluations), ElementsAre(8));
  EXPECT_EQ(Figure("drained"), 1);
  EXPECT_EQ(Figure("eval_updates"), 8);
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

// The actors take no further step before they have the weights.
TEST_F(TrainingLoopTest, InLockstepNoUpdateIsInFlightWhenWeightsAreSent) {
  run_.config.lockstep = true;
  run_.config.envs_per_actor = 2;
  run_.config.lockstep_steps = 6;  // 12 steps, 3 updates per phase
  delay_ = 3;
  Train(10, [&](PlayedBatches& batches) {
    batches.before = [&](uint64_t request) {
      EXPECT_EQ(sink_.weights.size(), (request - 1) / 3) << request;
      if (request > 10) Say(RunState::kStopping);
    };
  });
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
