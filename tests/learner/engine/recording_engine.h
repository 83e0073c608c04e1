// SPDX-License-Identifier: Apache-2.0
// An engine that forwards its operations to another engine and records each operation with its
// arrays and with every number that the host passes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "learner/engine/engine.h"

namespace shoal::learner {

class RecordingEngine : public Engine {
 public:
  // Borrows the engine.
  explicit RecordingEngine(Engine* engine) : engine_(engine) {}

  // The operations since the last call, one line each.
  std::vector<std::string> TakeOperations() { return std::exchange(operations_, {}); }

  const nn::ModuleContext& modules() const override { return engine_->modules(); }
  Array NewArray(int columns) override { return engine_->NewArray(columns); }
  Number NewNumber() override { return engine_->NewNumber(); }
  Moments NewMoments(int width) override { return engine_->NewMoments(width); }
  void Set(Number number, double value) override { engine_->Set(number, value); }
  void Put(std::span<const float> values, Array array) override { engine_->Put(values, array); }

  void Begin(const BatchView& drawn) override;
  Transitions Take(const BatchView& batch) override;
  Array TakeRows(std::span<float> values) override;
  std::optional<Outcome> End() override;
  Outcome WaitOutcome() override { return engine_->WaitOutcome(); }
  double Read(Number number) const override { return engine_->Read(number); }
  std::span<const float> ReadErrors() const override { return engine_->ReadErrors(); }
  std::vector<float> ReadRows(Array array) const override { return engine_->ReadRows(array); }
  std::function<std::vector<double>()> CopyMoments(Moments moments) const override {
    return engine_->CopyMoments(moments);
  }
  void SetMoments(Moments moments, std::span<const double> values) override {
    engine_->SetMoments(moments, values);
  }

  void JoinColumns(Array left, Array right, std::span<const ObservationSpec::Range> ranges,
                   Array joined) override;
  void SplitColumns(Array joined, Array left, Array right) override;
  void GatherLabels(Array observed, Array privileged, std::span<const LabelColumns> columns,
                    float unit, Array labels) override;
  void Standardise(Array x, Moments moments, float variance_floor, Array y) override;
  void AddToMoments(std::span<const float> vectors, Moments moments) override;
  void SampleSquashedGaussian(Array mean, Array log_std, Random* random,
                              const SquashedSample& sample) override;
  void SquashedGaussianBackward(const SquashedSample& sample, Array action_gradient,
                                Number temperature, Array mean_gradient,
                                Array log_std_gradient) override;
  void SquashedGaussianFigures(const SquashedSample& sample, Number entropy,
                               Number saturation) override;
  void AddClippedNoise(Array action, Number sigma, double limit, Random* random,
                       Array noisy) override;
  void Targets(const TargetTerms& terms, Array y) override;
  void AverageCopies(int copies, int shifts, Array y) override;
  void CriticLoss(std::span<const Array> q, Array y, const CriticRows& rows,
                  std::span<const Array> q_gradients, const CriticNumbers& figures) override;
  void EntropyActorLoss(Array log_prob, std::span<const Array> q, ActorValue value,
                        Number temperature, std::span<const Array> q_gradients,
                        Number loss) override;
  void DeterministicActorLoss(std::span<const Array> q, Array mean, Array action,
                              double mean_penalty, std::span<const Array> q_gradients, Number loss,
                              Number saturation) override;
  void LabelLoss(Array y, Array labels, float weight, float unit, Array gradient,
                 Number mean_square) override;
  void ClippedPolicyLoss(const ClippedPolicyTerms& terms, nn::ParameterSet* log_std,
                         Array mean_gradient, Array value_gradient,
                         const ClippedPolicyNumbers& figures) override;
  void GaussianFigures(const nn::ParameterSet& log_std, Number deviation, Number entropy) override;
  void Mean(Array values, Number mean) override;
  void OnHost(std::span<const Array> inputs, std::span<const Array> outputs,
              const HostOperation& operation) override;
  void Temperature(const nn::ParameterSet& log_temperature, Number temperature) override;
  void TemperatureLoss(Number temperature, Number entropy, float target_entropy,
                       Number loss) override;
  void StepTemperature(Number loss, double least, nn::ParameterSet* log_temperature,
                       nn::Adam* optimiser) override;
  void RequireFinite(Number number) override;
  void SetRateFactor(Number factor, nn::Adam* optimiser) override;
  void Gather(nn::Adam* optimiser, Number gradient_squares) override;
  void HoldSteps(Number number, double limit) override;
  void Step(nn::Adam* optimiser, std::span<nn::Module* const> changed, NextUse next_use) override;
  void MoveTowards(float tau, std::span<const nn::Following> targets) override;
  void MoveAverage(float rate, const nn::ParameterSet& online, nn::ParameterSet* average) override;

 private:
  template <class... Arguments>
  void Keep(const char* operation, const Arguments&... arguments);

  Engine* const engine_;
  std::vector<std::string> operations_;
};

}  // namespace shoal::learner
