// SPDX-License-Identifier: Apache-2.0
// The engine of the CPU: arrays in host memory, modules on oneDNN, operations as plain loops. End
// returns the outcome of the update that it ends.
//
// Each replica (common/nn/replica.h) has its own engine. Replicas exchange means over the whole
// batch, and the arrays that figures of the whole batch need, together with the gradients, so an
// update needs no additional synchronisation.
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "common/nn/precision.h"
#include "common/nn/replica.h"
#include "learner/engine/engine.h"
#include "learner/engine/squashed_gaussian.h"

namespace shoal::learner {

// Not movable. Used by the thread of its replica.
class CpuEngine final : public Engine {
 public:
  // Computes with the replica's rows of batches of `batch` rows. Borrows the replica.
  CpuEngine(nn::Precision precision, int batch, nn::Replica* replica);
  CpuEngine(const CpuEngine&) = delete;
  CpuEngine& operator=(const CpuEngine&) = delete;

  const nn::ModuleContext& modules() const override { return modules_; }
  Array NewArray(int columns) override;
  Number NewNumber() override;
  Moments NewMoments(int width) override;
  void Set(Number number, double value) override;
  void Put(std::span<const float> values, Array array) override;

  void Begin(const BatchView& drawn) override;
  Transitions Take(const BatchView& batch) override;
  Array TakeRows(std::span<float> values) override;
  std::optional<Outcome> End() override;
  Outcome WaitOutcome() override;
  double Read(Number number) const override;
  std::span<const float> ReadErrors() const override { return errors_; }
  std::vector<float> ReadRows(Array array) const override;
  std::function<std::vector<double>()> CopyMoments(Moments moments) const override;
  void SetMoments(Moments moments, std::span<const double> values) override;

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
  // A mean over this replica's rows, which Gather turns into the mean over the batch.
  struct OwnMean {
    Number number;
    bool rounds;  // whether to round to f32
  };
  // A step of this update that End may undo.
  struct Taken {
    nn::Adam* optimiser;
    std::vector<nn::Module*> changed;
  };

  size_t Rows() const { return size_t(modules_.batch); }
  // Whether steps and moves have an effect.
  bool Moves() const { return outcome_.finite && !outcome_.held; }
  // Keeps a mean over the replica's rows for the next Gather.
  void AddMean(double own, Number number, bool rounds);
  void FinishCriticLoss(const std::vector<std::vector<float>>& whole);

  const int batch_;  // B
  nn::Replica* const replica_;
  const nn::ModuleContext modules_;
  std::deque<std::vector<float>> arrays_;
  std::deque<double> numbers_;
  std::deque<std::vector<double>> moments_;

  bool updating_ = false;
  Outcome outcome_;         // of the current update so far
  bool overflows_ = false;  // the gradients that were gathered last
  std::vector<Taken> taken_;

  // Since the last Gather.
  std::vector<OwnMean> means_;
  // q_i and y of a critic's loss, then the weights, if there are any; empty: no loss.
  std::vector<std::span<const float>> critic_arrays_;
  CriticRows critic_rows_;
  CriticNumbers critic_figures_;

  std::vector<float> errors_;  // (B), of the update's critic

  std::vector<float> noise_;  // (b, A)
};

}  // namespace shoal::learner
