// SPDX-License-Identifier: Apache-2.0
#include "learner/weights_sender.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include "common/nn/safetensors.h"
#include "tests/learner/training_fixture.h"

namespace shoal::learner {
namespace {

constexpr size_t kFloats = 16'000'000;  // 64 MB

// In use, those that malloc has from the system one by one included.
size_t MemoryInUse() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

// An actor of one tensor; nothing else of an agent is asked for.
class LargeAgent final : public Agent {
 public:
  UpdateOutcome Update(const BatchView&, const OnStageEnd&) override { return {}; }
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

class MeasuringOutlet final : public Outlet {
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

// The transport makes a copy as well: three in all, of which two are there at once.
TEST(WeightsSender, WhatTheTransportTakesIsTheOnlyCopyThen) {
  for (const nn::Precision precision : {nn::Precision::kF32, nn::Precision::kBf16}) {
    const size_t bytes_each = precision == nn::Precision::kBf16 ? 2 : 4;
    const LargeAgent agent;
    MeasuringOutlet outlet;
    WeightsSender sender(SmallRun(), precision, /*session=*/1, agent, outlet);
    const size_t before = MemoryInUse();
    sender.Send(0);
    EXPECT_GE(outlet.payload, kFloats * bytes_each);
    EXPECT_LT(outlet.payload, kFloats * bytes_each + 1000);
    EXPECT_LT(outlet.memory, before + outlet.payload + outlet.payload / 10);
    EXPECT_EQ(sender.sent(), 1u);
  }
}

}  // namespace
}  // namespace shoal::learner
