// SPDX-License-Identifier: Apache-2.0
#include "learner/weights_sender.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <numbers>
#include <string>

#include "common/nn/policy.h"
#include "common/nn/precision.h"
#include "common/nn/safetensors.h"
#include "learner/agent/algorithms.h"
#include "learner/agent/ppo/ppo_agent.h"
#include "tests/learner/agent/agent_fixture.h"
#include "tests/learner/training_fixture.h"

namespace shoal::learner {
namespace {

constexpr size_t kFloats = 16'000'000;  // 64 MB

// Bytes in use, including blocks that malloc maps individually.
size_t MemoryInUse() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

// An actor of one tensor; nothing else of an agent is asked for.
class LargeAgent final : public Agent {
 public:
  std::vector<UpdateOutcome> Submit(const BatchView&, const OnStageEnd&) override { return {}; }
  uint64_t updates() const override { return 1; }
  nn::TensorMap PolicyTensors() const override {
    nn::NamedTensor tensor{"F32", {int64_t{kFloats}}, {}};
    tensor.data.resize(kFloats * sizeof(float));
    return {{"actor.weight", std::move(tensor)}};
  }
  nn::TensorMap AveragedPolicyTensors() const override { return PolicyTensors(); }
  nn::TensorMap AllTensors() const override { return PolicyTensors(); }
  void Restore(const nn::TensorMap&, const std::string&) override {}
};

class MeasuringSink final : public LearnerSink {
 public:
  bool Publish(const WeightsMessage& weights) override {
    payload = weights.payload.size();
    memory = MemoryInUse();
    return true;
  }
  bool WeightsArrived() override { return true; }
  bool Publish(const EvalWeightsMessage&) override { return true; }
  void Publish(const MetricsMessage&) override {}
  void Publish(const LearnerProgress&) override {}

  size_t payload = 0, memory = 0;
};

// The transport makes another copy: three copies in all, two at the same time.
TEST(WeightsSender, WhatTheTransportTakesIsTheOnlyCopyThen) {
  for (const nn::Precision precision : {nn::Precision::kF32, nn::Precision::kBf16}) {
    const size_t bytes_each = precision == nn::Precision::kBf16 ? 2 : 4;
    const LargeAgent agent;
    MeasuringSink sink;
    WeightsSender sender(SmallRun(), precision, /*session=*/1, agent, sink);
    const size_t before = MemoryInUse();
    sender.Send(0);
    EXPECT_GE(sink.payload, kFloats * bytes_each);
    EXPECT_LT(sink.payload, kFloats * bytes_each + 1000);
    EXPECT_LT(sink.memory, before + sink.payload + sink.payload / 10);
    EXPECT_EQ(sender.sent(), 1u);
  }
}

// Keeps the payload of the weights sent last.
class KeepingSink final : public LearnerSink {
 public:
  bool Publish(const WeightsMessage& weights) override {
    payload.assign(weights.payload.begin(), weights.payload.end());
    return true;
  }
  bool WeightsArrived() override { return true; }
  bool Publish(const EvalWeightsMessage&) override { return true; }
  void Publish(const MetricsMessage&) override {}
  void Publish(const LearnerProgress&) override {}

  std::string payload;
};

// Draws an action for each row of a rollout, with its log-density (Eq. 22), as an actor does.
void Act(nn::Policy* policy, const BatchView& rollout, Random* random) {
  const auto rows = int(rollout.reward.size());
  const nn::PolicyOutput out =
      policy->Forward(rows, rollout.obs_frames.data(), rollout.obs_vector.data());
  const size_t actions = out.mean.size() / size_t(rows);
  for (size_t b = 0; b < size_t(rows); ++b) {
    double log_prob = 0;
    for (size_t i = b * actions; i < (b + 1) * actions; ++i) {
      const double noise = random->Normal();
      rollout.drawn_action[i] = float(out.mean[i] + std::exp(double{out.log_std[i]}) * noise);
      log_prob += -noise * noise / 2 - out.log_std[i] - std::log(2 * std::numbers::pi) / 2;
    }
    rollout.log_prob[b] = float(log_prob);
  }
}

// If actors act by the learner's initial parameters, the ratios of its first minibatch are 1.
TEST(WeightsSender, OnPolicyActorsActByThePolicyThatTheLearnerHas) {
  if (nn::ChoosePrecision("auto", /*pixels=*/true) != nn::Precision::kBf16) {
    GTEST_SKIP() << "this CPU has no bf16 arithmetic";
  }
  RunConfig run{SmallConfig(), SmallSpec()};
  run.config.learner.algorithm = "ppo";
  run.config.learner.learning_rate = 1e-2;
  run.config.ppo.epochs = 1;
  run.config.ppo.initial_log_std = -2;
  run.spec.drawn_actions = true;
  const int rows = run.config.learner.batch;
  const auto agent = MakeAgent(run.config, run.spec, nn::Precision::kBf16);
  for (uint64_t u = 0; u < 3; ++u) {
    ASSERT_TRUE(agent->Update(RandomBatch(run.spec, rows, u, /*rollout=*/true).View()).finite);
  }
  KeepingSink sink;
  WeightsSender(run, nn::Precision::kBf16, /*session=*/1, *agent, sink).Send(0);
  nn::Policy actor(run.config.network, run.spec, nn::Precision::kBf16, rows);
  actor.Load(nn::ReadSafetensors(sink.payload, "sent"), "sent");
  const RandomBatch rollout(run.spec, rows, 9, /*rollout=*/true);
  Random random(5);
  Act(&actor, rollout.View(), &random);
  const UpdateOutcome outcome = agent->Update(rollout.View());
  ASSERT_TRUE(outcome.finite);
  // mean(r - 1 - log r) is half the mean square of log r where all are small.
  EXPECT_LT(std::sqrt(2 * Get(outcome, kApproxKl)), 1e-4);
}

// Off policy actors may act by rounded parameters, which are half as many bytes.
TEST(WeightsSender, OffPolicyWeightsHaveTheRunsPrecision) {
  const LargeAgent agent;
  for (const char* algorithm : {"sac", "ppo"}) {
    RunConfig run = SmallRun();
    run.config.learner.algorithm = algorithm;
    KeepingSink sink;
    WeightsSender(run, nn::Precision::kBf16, /*session=*/1, agent, sink).Send(0);
    const nn::TensorMap sent = nn::ReadSafetensors(sink.payload, "sent");
    EXPECT_EQ(sent.at("actor.weight").dtype, std::string(algorithm) == "sac" ? "BF16" : "F32");
  }
}

}  // namespace
}  // namespace shoal::learner
