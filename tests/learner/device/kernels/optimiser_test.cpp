// SPDX-License-Identifier: Apache-2.0
// Compares steps and moves with those of the CPU, and checks what the flag prevents.
#include "learner/device/kernels/optimiser.h"

#include "common/nn/adam.h"
#include "common/nn/parameter_set.h"
#include "learner/device/kernels/flags.h"
#include "learner/device/kernels/parameter_sets.h"
#include "learner/device/kernels/temperature.h"
#include "tests/learner/device/kernels/kernel_fixture.h"

namespace shoal::learner::kernels {
namespace {

using nn::ParameterSet;

constexpr double kRate = 3e-3, kEpsilon = 1e-8;

class OptimiserKernels : public KernelTest {
 protected:
  // A parameter set in the memory of a device.
  AdamSet NewSet(const ParameterSet& set) {
    const auto n = size_t(set.trained_size());
    const std::vector<float> zeros(n, 0.f);
    return {.size = int64_t(n),
            .trained = int64_t(n),
            .value = In(std::vector<float>(set.values(), set.values() + n)),
            .m = In(zeros),
            .v = In(zeros),
            .former_value = Out(n),
            .former_m = Out(n),
            .former_v = Out(n),
            .rounded = Out<uint16_t>(n)};
  }
  std::vector<float> ValuesOf(const float* values, int64_t n) { return {values, values + n}; }

  // Gradients of one step, for the CPU's set and in the device's memory.
  const float* NewGradients(ParameterSet* set) {
    const std::vector<float> gradients = Random(size_t(set->trained_size()), -2, 2);
    std::ranges::copy(gradients, set->gradients());
    return In(gradients);
  }

  void CompareSteps(double max_norm);

  ParameterSet large_{{{"large", {31, 97}}}, ParameterSet::Use::kTraining};  // several blocks
  ParameterSet small_{{{"small", {5}}}, ParameterSet::Use::kTraining};
  Flags* flags_ = In(std::vector<Flags>{{1, 1, 0, 0}});
  AdamState* state_ = In(std::vector<AdamState>{{0, 0}});
};

void OptimiserKernels::CompareSteps(double max_norm) {
  std::ranges::copy(Random(size_t(large_.size())), large_.values());
  std::ranges::copy(Random(size_t(small_.size())), small_.values());
  nn::Adam expected({&large_, &small_}, {.rate = kRate, .epsilon = kEpsilon, .max_norm = max_norm});
  expected.set_rate_factor(0.5);
  Adam step{.set_count = 2,
            .sets = {NewSet(large_), NewSet(small_)},
            .options = {.rate = kRate,
                        .epsilon = kEpsilon,
                        .max_norm = max_norm,
                        .rate_factor = In(std::vector<double>{0.5})},
            .state = state_,
            .flags = flags_,
            .finished = Counters(1)};
  for (int i = 0; i < 3; ++i) {
    step.gradients[0] = NewGradients(&large_);
    step.gradients[1] = NewGradients(&small_);
    SumOfSquares sum{.set_count = 2,
                     .sets = {{step.gradients[0], large_.trained_size()},
                              {step.gradients[1], small_.trained_size()}},
                     .finished = Counters(1),
                     .squares = Out<double>(1)};
    sum.partials = Out<double>(size_t(sum.blocks()));
    Run(sum);
    const double squares = expected.GatherGradients();
    EXPECT_NEAR(*sum.squares, squares, 1e-12 * squares);
    step.squares = sum.squares;
    Run(step);
    expected.Step();
    EXPECT_EQ(state_->steps, i + 1);
    EXPECT_EQ(state_->taken, 1);
    ExpectClose(step.sets[0].value, {large_.values(), size_t(large_.trained_size())}, 1e-6);
    ExpectClose(step.sets[1].value, {small_.values(), size_t(small_.trained_size())}, 1e-6);
    EXPECT_EQ(step.sets[0].rounded[77], ToBf16(step.sets[0].value[77]));
  }
}

TEST_F(OptimiserKernels, AdamFollowsTheCpu) { CompareSteps(/*max_norm=*/0); }

TEST_F(OptimiserKernels, LargeGradientsAreClipped) { CompareSteps(/*max_norm=*/0.3); }

// A step, a loss that is not finite, the end: everything is as before the update, and later updates
// have no effect.
TEST_F(OptimiserKernels, AnUpdateThatIsNotFiniteLeavesNothing) {
  std::ranges::copy(Random(size_t(large_.size())), large_.values());
  AdamSet large = NewSet(large_), small = NewSet(small_);
  const int32_t* batch_finite = In(std::vector<int32_t>{1});
  Adam step{.set_count = 2,
            .sets = {large, small},
            .gradients = {NewGradients(&large_), NewGradients(&small_)},
            .options = {.rate = kRate, .epsilon = kEpsilon},
            .squares = In(std::vector<double>{1.0}),
            .state = state_,
            .flags = flags_,
            .finished = Counters(1)};
  const BeginUpdate begin{batch_finite, flags_, 1, {state_}};
  const EndUpdate end{.set_count = 2,
                      .sets = {large, small},
                      .states = {state_, state_},
                      .counts = {true, false},
                      .flags = flags_,
                      .finished = Counters(1)};
  Run(begin);
  Run(step);
  Run(end);
  EXPECT_EQ(state_->steps, 1);
  const auto values = ValuesOf(large.value, large.size), m = ValuesOf(large.m, large.size);
  const auto v = ValuesOf(large.v, large.size);

  Run(begin);
  EXPECT_EQ(state_->taken, 0);
  Run(step);
  EXPECT_NE(ValuesOf(large.value, large.size), values);
  EXPECT_EQ(state_->steps, 2);
  Run(RequireFinite{2, {In(std::vector<double>{1.0}), In(std::vector<double>{NAN})}, flags_});
  EXPECT_EQ(flags_->finite, 0);
  Run(end);
  EXPECT_EQ(ValuesOf(large.value, large.size), values);
  EXPECT_EQ(ValuesOf(large.m, large.size), m);
  EXPECT_EQ(ValuesOf(large.v, large.size), v);
  EXPECT_EQ(large.rounded[1500], ToBf16(values[1500]));
  EXPECT_EQ(state_->steps, 1);
  EXPECT_EQ(flags_->halted, 1);

  Run(begin);
  EXPECT_EQ(flags_->finite, 0);
  EXPECT_EQ(flags_->batch_finite, 1);
  Run(step);
  Run(end);
  EXPECT_EQ(ValuesOf(large.value, large.size), values);
  EXPECT_EQ(state_->steps, 1);
}

// Statistics follow the trained numbers of a set, within the same block.
TEST_F(OptimiserKernels, AStepAppliesMeasuredStatisticsAndAnUndoRestoresThem) {
  constexpr int64_t kTrained = 64, kSize = 64 + 1500;
  ParameterSet plain{{{"plain", {kTrained}}}, ParameterSet::Use::kTraining};
  const std::vector<float> values = Random(size_t(kSize)), next = Random(size_t(kSize - kTrained));
  const AdamSet set{.size = kSize,
                    .trained = kTrained,
                    .value = In(values),
                    .m = In(std::vector<float>(kTrained, 0.f)),
                    .v = In(std::vector<float>(kTrained, 0.f)),
                    .former_value = Out(size_t(kSize)),
                    .former_m = Out(kTrained),
                    .former_v = Out(kTrained),
                    .rounded = Out<uint16_t>(size_t(kSize)),
                    .next_statistics = In(next)};
  std::copy_n(values.begin(), kTrained, plain.values());
  const Adam step{.set_count = 1,
                  .sets = {set},
                  .gradients = {NewGradients(&plain)},
                  .options = {.rate = kRate, .epsilon = kEpsilon},
                  .squares = In(std::vector<double>{1.0}),
                  .state = state_,
                  .flags = flags_,
                  .finished = Counters(1)};
  flags_->held = 1;
  Run(step);
  EXPECT_EQ(ValuesOf(set.value, kSize), values) << "a held step";
  flags_->held = 0;
  Run(step);
  nn::Adam expected({&plain}, {.rate = kRate, .epsilon = kEpsilon});
  expected.Step();
  ExpectClose(set.value, {plain.values(), size_t(kTrained)}, 1e-6);
  EXPECT_EQ(ValuesOf(set.value + kTrained, kSize - kTrained), next);
  EXPECT_EQ(set.rounded[1000], ToBf16(set.value[1000]));
  flags_->finite = 0;
  Run(EndUpdate{.set_count = 1,
                .sets = {set},
                .states = {state_},
                .counts = {true},
                .flags = flags_,
                .finished = Counters(1)});
  EXPECT_EQ(ValuesOf(set.value, kSize), values);
  EXPECT_EQ(ValuesOf(set.m, kTrained), std::vector<float>(kTrained, 0.f));
}

TEST_F(OptimiserKernels, AStepThatWouldOverflowClearsTheFlag) {
  AdamSet set = NewSet(small_);
  const std::vector<float> before = ValuesOf(set.value, set.size);
  Adam step{.set_count = 1,
            .sets = {set},
            .gradients = {NewGradients(&small_)},
            .options = {.rate = kRate, .epsilon = kEpsilon},
            .squares = In(std::vector<double>{1e39}),
            .state = state_,
            .flags = flags_,
            .finished = Counters(1)};
  flags_->held = 1;
  Run(step);
  EXPECT_EQ(flags_->finite, 1) << "a held step overflows nothing";
  flags_->held = 0;
  Run(step);
  EXPECT_EQ(flags_->finite, 0);
  EXPECT_EQ(ValuesOf(set.value, set.size), before);
  EXPECT_EQ(state_->steps, 0);
}

TEST_F(OptimiserKernels, HeldStepsHaveNoEffectAndClearNothing) {
  double* number = In(std::vector<double>{0.1});
  Run(HoldSteps{number, 0.1, flags_});
  EXPECT_EQ(flags_->held, 0);
  *number = 0.2;
  Run(HoldSteps{number, 0.1, flags_});
  EXPECT_EQ(flags_->held, 1);
  Run(RequireFinite{1, {In(std::vector<double>{INFINITY})}, flags_});
  EXPECT_EQ(flags_->finite, 1);
  std::vector<float> target(3, 1.f);
  float* moved = In(target);
  Run(MoveTowards{.set_count = 1,
                  .sets = {{.size = 3, .trained = 3, .online = In(Random(3)), .target = moved}},
                  .tau = 0.5f,
                  .flags = flags_});
  ExpectClose(moved, target, 0);
}

TEST_F(OptimiserKernels, TargetsFollow) {
  constexpr size_t kTrained = 1500, kSize = 1503;
  const std::vector<float> online = Random(kSize), start = Random(kSize), other = Random(40);
  std::vector<float> expected = start, second = Random(40);
  float *target = In(start), *of_second = In(second);
  auto* rounded = Out<uint16_t>(kSize);
  Run(MoveTowards{.set_count = 2,
                  .sets = {{.size = kSize,
                            .trained = kTrained,
                            .online = In(online),
                            .target = target,
                            .rounded = rounded},
                           {.size = 40, .trained = 40, .online = In(other), .target = of_second}},
                  .tau = 0.3f,
                  .flags = flags_});
  nn::MoveTowards(0.3f, online.data(), kTrained, expected.data());
  nn::MoveTowards(0.3f, other.data(), 40, second.data());
  std::copy(online.begin() + kTrained, online.end(), expected.begin() + kTrained);
  ExpectClose(target, expected, 1e-6);
  ExpectClose(of_second, second, 1e-6);
  ExpectClose(FromBf16s(rounded, kSize).data(), expected, 0.005);
}

TEST_F(OptimiserKernels, NumbersAreRoundedToBf16) {
  const std::vector<float> values = Random(1500), more{NAN, INFINITY, -0.f};
  auto *first = Out<uint16_t>(1500), *second = Out<uint16_t>(3);
  Run(RoundToBf16{.set_count = 2, .sets = {{1500, In(values), first}, {3, In(more), second}}});
  ExpectClose(FromBf16s(first, 1500).data(), values, 0.004);
  EXPECT_TRUE(std::isnan(FromBf16(second[0])));
  EXPECT_EQ(second[1], 0x7f80);
  EXPECT_EQ(second[2], 0x8000);
}

TEST_F(OptimiserKernels, TheTemperatureStepsAndKeepsItsBound) {
  ParameterSet set({{"log", {1}}}, ParameterSet::Use::kTraining);
  set.values()[0] = -1.2f;
  nn::Adam adam({&set}, {.rate = 0.1});
  AdamSet own = NewSet(set);
  double *temperature = Out<double>(1), *loss = Out<double>(1);
  const double* entropy = In(std::vector<double>{0.9});
  const auto least = float(std::log(0.27));
  for (int i = 0; i < 3; ++i) {
    Run(Temperature{own.value, temperature});
    EXPECT_NEAR(*temperature, std::exp(set.values()[0]), 1e-6);
    Run(TemperatureLoss{temperature, entropy, -0.4f, loss});
    EXPECT_NEAR(*loss, *temperature * 1.3, 1e-6);
    set.gradients()[0] = float(*loss);
    adam.Step();
    set.values()[0] = std::max(set.values()[0], least);
    Run(StepTemperature{.set = own,
                        .options = {.rate = 0.1, .epsilon = 1e-8},
                        .loss = loss,
                        .least = least,
                        .state = state_,
                        .flags = flags_});
    EXPECT_NEAR(own.value[0], set.values()[0], 1e-6);
    EXPECT_EQ(state_->steps, i + 1);
  }
  EXPECT_EQ(own.value[0], least);
  // An undo restores the temperature, and keeps the zeros behind it.
  const std::vector<float> values = ValuesOf(own.value, own.size);
  ASSERT_GT(own.size, 1);
  *loss = -5;
  Run(StepTemperature{.set = own,
                      .options = {.rate = 0.1, .epsilon = 1e-8},
                      .loss = loss,
                      .least = least,
                      .state = state_,
                      .flags = flags_});
  EXPECT_GT(own.value[0], least);
  flags_->finite = 0;
  Run(EndUpdate{.set_count = 1,
                .sets = {own},
                .states = {state_},
                .counts = {true},
                .flags = flags_,
                .finished = Counters(1)});
  EXPECT_EQ(ValuesOf(own.value, own.size), values);
  EXPECT_EQ(ValuesOf(own.m, own.size).back(), 0);
  Run(StepTemperature{.set = own,
                      .options = {.rate = 0.1, .epsilon = 1e-8},
                      .loss = loss,
                      .least = least,
                      .state = state_,
                      .flags = flags_});
  EXPECT_EQ(own.value[0], least);
}

}  // namespace
}  // namespace shoal::learner::kernels
