// SPDX-License-Identifier: Apache-2.0
// Interface of the engines with which algorithms compute: arrays, modules, and the operations
// between modules. An algorithm combines operations and never reads an array itself, so one version
// of it works with every engine.
//
// An update begins with Begin and ends with End. Its operations and their order depend on the
// configuration and on counters of the host, never on computed numbers, because nothing is read
// before End. An update without a step computes results that are read after End. Besides batch and
// random draws, all values that change from update to update are in the engine's memory; the host
// sets rates of schedules by Set. An engine may therefore record the operations of an update once
// and replay the recording.
//
// A flag in the engine's memory says whether all numbers are finite. Begin sets the flag; a batch,
// a loss or a gradient that is not finite clears it for the rest of the update. While the flag is
// cleared, steps and moves have no effect; End undoes the steps made before.
//
// An update that has ended is in flight until its outcome is returned, by its own End, by the End
// of a later update, or by WaitOutcome. Outcomes are returned in the order of the updates. An
// engine that several replicas use decides by the number of updates in flight when End returns an
// outcome, not by time, so that replicas agree. If an outcome is not finite, the updates that are
// still in flight had no effect and have no outcome.
//
// Each of several replicas has b rows of each batch of B rows. Losses and gradients are means over
// the replica's rows; Gather turns them into means over the whole batch. All replicas call the same
// functions in the same order.
//
// Equations are numbered in docs/algorithm.md. Dimensions: B rows of the batch, b rows of this
// replica, A actions, L labels. Arrays are row-major f32; (b, A) and so on are shapes. An operation
// overwrites its results, which must not overlap its inputs, and trusts the sizes of its arrays.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/base/random.h"
#include "common/nn/adam.h"
#include "common/nn/array.h"
#include "common/nn/module.h"
#include "common/wire/batch_schema.h"
#include "learner/engine/columns.h"
#include "learner/engine/operands.h"

namespace shoal::learner {

// The next use of parameters that a step changes.
enum class NextUse { kThisUpdate, kNextUpdate };

// One thread.
class Engine {
 public:
  virtual ~Engine() = default;

  // ---- Memory and modules ----

  // Context with which modules and optimisers of this engine are built; its batch is b.
  virtual const nn::ModuleContext& modules() const = 0;
  // Makes an array of zeros (b, columns), which lives as long as the engine.
  virtual Array NewArray(int columns) = 0;
  virtual Number NewNumber() = 0;
  // Makes moments (moments.h) of vectors of `width` numbers, without any vector so far.
  virtual Moments NewMoments(int width) = 0;
  // Sets a number that the operations of later updates read, for example the rate of a schedule.
  // The operations themselves stay the same. Not within an update.
  virtual void Set(Number number, double value) = 0;
  // Copies this replica's rows of `values` (B, columns) to the array. Not within an update.
  virtual void Put(std::span<const float> values, Array array) = 0;

  // ---- An update ----

  // Begins an update. Sets the flag if every float of `drawn`, the whole batch, is finite, else
  // clears it.
  virtual void Begin(const BatchView& drawn) = 0;
  // Returns this replica's rows of the whole batch `batch`, which is borrowed until End.
  virtual Transitions Take(const BatchView& batch) = 0;
  struct Outcome {
    bool finite = true;        // the flag
    bool batch_finite = true;  // false: all results of this update are useless
    bool held = false;         // HoldSteps has disabled the steps
  };
  // Returns this replica's rows of `values` (B), which the host has computed for this update. They
  // are borrowed until End.
  virtual Array TakeRows(std::span<float> values) = 0;
  // Ends the update. If the flag is cleared, parameters, moments and statistics are the same as
  // before Begin. Returns the outcome of the oldest update in flight, or nullopt if the engine lets
  // more updates be in flight first. An engine that waits for each update returns its outcome.
  virtual std::optional<Outcome> End() = 0;
  // Waits for the oldest update in flight, and returns its outcome. CHECKs that there is one. Not
  // within an update.
  virtual Outcome WaitOutcome() = 0;
  // Ends the update and waits for its outcome. No other update may be in flight.
  Outcome EndAndWait() {
    const std::optional<Outcome> outcome = End();
    return outcome ? *outcome : WaitOutcome();
  }
  // Reads a number as it was at the end of the update whose outcome was returned last. Not within
  // an update.
  virtual double Read(Number number) const = 0;
  // The errors max_i |q_i - y| (B) of the critic's loss, for all rows of the batch, in the update
  // whose outcome was returned last. Empty unless CriticRows::returns_errors was set. Valid until
  // the next outcome. Not within an update.
  virtual std::span<const float> ReadErrors() const = 0;
  // Waits for all updates in flight, and reads this replica's rows. Not within an update.
  virtual std::vector<float> ReadRows(Array array) const = 0;
  // Begins a copy of moments as the updates so far leave them, without waiting for updates in
  // flight. The returned function waits for the copy and returns it; it must not outlive the
  // engine. Not within an update.
  virtual std::function<std::vector<double>()> CopyMoments(Moments moments) const = 0;
  // Waits for all updates in flight. Not within an update.
  std::vector<double> ReadMoments(Moments moments) const { return CopyMoments(moments)(); }
  virtual void SetMoments(Moments moments, std::span<const double> values) = 0;

  // ---- Inputs ----

  // joined[b] = [ left[b] | the columns `ranges` of right[b] ]
  virtual void JoinColumns(Array left, Array right, std::span<const ObservationSpec::Range> ranges,
                           Array joined) = 0;
  // Splits the columns of joined[b] = [ left[b] | right[b] ].
  virtual void SplitColumns(Array joined, Array left, Array right) = 0;
  // labels (b, L): columns of `observed` and `privileged`, or differences of two columns, divided
  // by `unit`.
  virtual void GatherLabels(Array observed, Array privileged, std::span<const LabelColumns> columns,
                            float unit, Array labels) = 0;

  // y = clip((x - mean) / sqrt(variance + 1e-8), -10, 10) with mean and variance of `moments`;
  // variances below the floor become the floor. x, y (b, V).
  virtual void Standardise(Array x, Moments moments, float variance_floor, Array y) = 0;
  // If the flag is set: adds vectors (N, V) of the host, those of all replicas, to the moments.
  // Within an update, this must be the last operation that uses these moments.
  virtual void AddToMoments(std::span<const float> vectors, Moments moments) = 0;

  // ---- Actions ----

  // a = tanh(u), u = mean + exp(log_std) eps, eps ~ N(0, 1) of `random`: squashed_gaussian.h (Eq.
  // 4). mean, log_std (b, A).
  virtual void SampleSquashedGaussian(Array mean, Array log_std, Random* random,
                                      const SquashedSample& sample) = 0;
  // Computes dL/dmean and dL/dlog_std (b, A) from dL/da (b, A) and dL/dlog pi = temperature / b.
  virtual void SquashedGaussianBackward(const SquashedSample& sample, Array action_gradient,
                                        Number temperature, Array mean_gradient,
                                        Array log_std_gradient) = 0;
  // Computes the entropy -mean log pi, and the share of |a| > 0.99, over the whole batch; available
  // after the next Gather.
  virtual void SquashedGaussianFigures(const SquashedSample& sample, Number entropy,
                                       Number saturation) = 0;
  // noisy = clip(action + clip(sigma eps, -limit, limit), -1, 1), eps ~ N(0, 1) of `random` (Eq.
  // 18, 31). action (b, A).
  virtual void AddClippedNoise(Array action, Number sigma, double limit, Random* random,
                               Array noisy) = 0;

  // ---- Targets and losses ----

  // Eq. 5, 18 and 20:
  //   y = reward_scale r + bootstrap discount (clip(min_i q'_i, bounds) - temperature log pi')
  // Eq. 30: if terms.drawn > 0, i runs over as many critics, which DrawSubset (draw_subset.h) draws
  // once for the whole batch.
  virtual void Targets(const TargetTerms& terms, Array y) = 0;
  // Eq. 15: replaces each group of `copies` consecutive targets by the mean of its first `shifts`
  // targets; 0 = of all.
  virtual void AverageCopies(int copies, int shifts, Array y) = 0;
  // Eq. 6: L = sum_i mean_b (q_i - y)^2, changed by `rows` as in Eq. 34. Computes dL/dq_i (b); the
  // figures are available after the next Gather.
  virtual void CriticLoss(std::span<const Array> q, Array y, const CriticRows& rows,
                          std::span<const Array> q_gradients, const CriticNumbers& figures) = 0;
  // Eq. 7 and 30: L = mean_b (temperature log pi - v), v = min_i q_i or mean_i q_i. Computes
  // dL/dq_i (b); L is available after the next Gather.
  virtual void EntropyActorLoss(Array log_prob, std::span<const Array> q, ActorValue value,
                                Number temperature, std::span<const Array> q_gradients,
                                Number loss) = 0;
  // Eq. 19 and 32: L = -mean_b min_i q_i + mean_penalty mean_ba m^2, where m (b, A) are the
  // policy's outputs before tanh. Computes dL/dq_i (b); L and the share of |action| > 0.99 are
  // available after the next Gather.
  virtual void DeterministicActorLoss(std::span<const Array> q, Array mean, Array action,
                                      double mean_penalty, std::span<const Array> q_gradients,
                                      Number loss, Number saturation) = 0;
  // Eq. 27: L = weight / (B L) sum (y - label)^2. Computes dL/dy (b, L); the mean square, times
  // unit^2, is available after the next Gather.
  virtual void LabelLoss(Array y, Array labels, float weight, float unit, Array gradient,
                         Number mean_square) = 0;
  // Eq. 22 and 24: clipped_policy_loss.h. Computes dL/dmean (b, A), dL/dvalue (b) and the gradient
  // of `log_std` (A); the figures are available after the next Gather.
  virtual void ClippedPolicyLoss(const ClippedPolicyTerms& terms, nn::ParameterSet* log_std,
                                 Array mean_gradient, Array value_gradient,
                                 const ClippedPolicyNumbers& figures) = 0;
  // The mean deviation and the entropy of a Gaussian whose log deviations are the parameters
  // `log_std` (A).
  virtual void GaussianFigures(const nn::ParameterSet& log_std, Number deviation,
                               Number entropy) = 0;
  // Computes the mean of values (b) over the whole batch; available after the next Gather.
  virtual void Mean(Array values, Number mean) = 0;

  // Runs an operation that only one algorithm needs, on the host. `operation` reads the numbers of
  // `inputs` and overwrites the numbers of `outputs`; it must depend on its arguments alone.
  using HostOperation = std::function<void(std::span<const std::span<const float>> inputs,
                                           std::span<const std::span<float>> outputs)>;
  virtual void OnHost(std::span<const Array> inputs, std::span<const Array> outputs,
                      const HostOperation& operation) = 0;

  // ---- Temperature ----

  // exp of the only parameter of `log_temperature`.
  virtual void Temperature(const nn::ParameterSet& log_temperature, Number temperature) = 0;
  // Eq. 8: L = temperature (entropy - target_entropy), which is dL/dlog temperature as well.
  virtual void TemperatureLoss(Number temperature, Number entropy, float target_entropy,
                               Number loss) = 0;
  // One optimiser step with the gradient `loss`. Afterwards the temperature is at least `least`.
  virtual void StepTemperature(Number loss, double least, nn::ParameterSet* log_temperature,
                               nn::Adam* optimiser) = 0;

  // ---- The flag, steps and moves ----

  // Clears the flag if the number is not finite, unless HoldSteps has disabled the steps.
  virtual void RequireFinite(Number number) = 0;
  // Sets the rate of the optimiser's following steps to `factor` times its configured rate.
  virtual void SetRateFactor(Number factor, nn::Adam* optimiser) = 0;
  // Turns the optimiser's gradients, and the figures of losses since the last Gather, into means
  // over the whole batch. gradient_squares: the sum of the gradients' squares.
  virtual void Gather(nn::Adam* optimiser, Number gradient_squares) = 0;
  // If number > limit, the following steps and moves of this update have no effect. The flag does
  // not change.
  virtual void HoldSteps(Number number, double limit) = 0;
  // Clears the flag if the step would overflow. If the flag is set: makes one step with the
  // gathered gradients and refreshes `changed`, the modules that have these parameters. At most
  // once per update for each optimiser.
  virtual void Step(nn::Adam* optimiser, std::span<nn::Module* const> changed,
                    NextUse next_use) = 0;
  // If the flag is set: moves each target by `tau` towards its online module (Eq. 9). The next
  // update uses the targets.
  virtual void MoveTowards(float tau, std::span<const nn::Following> targets) = 0;
  // If the flag is set: the same for an average that belongs to no module (Eq. 12).
  virtual void MoveAverage(float rate, const nn::ParameterSet& online,
                           nn::ParameterSet* average) = 0;
};

}  // namespace shoal::learner
