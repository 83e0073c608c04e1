// SPDX-License-Identifier: Apache-2.0
// An engine that computes with a device (device.h). Arrays, parameters and moments are in the
// device's memory. Operations and networks append commands to a list; End runs the list. If an
// earlier update had the same list, End replays the recording of that list.
//
// Up to `in_flight` updates are in flight when End returns: while the device computes them, the
// host prepares the next update and copies its inputs.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "common/nn/precision.h"
#include "learner/device/device.h"
#include "learner/device/device_parameters.h"
#include "learner/device/landing.h"
#include "learner/device/modules/device_networks.h"
#include "learner/device/recordings.h"
#include "learner/device/workspace.h"
#include "learner/engine/engine.h"

namespace shoal::learner::device {

// Not movable. One thread. Outlives the modules and optimisers that are built with it. Throws the
// errors of the device.
class DeviceEngine final : public Engine {
 public:
  static constexpr int kInFlight = 2;

  // Computes whole batches of `batch` rows. Borrows the device.
  DeviceEngine(Device* device, nn::Precision precision, int batch, int in_flight = kInFlight);
  ~DeviceEngine() override;

  int64_t recorded() const { return recordings_.recorded(); }  // different lists so far

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
  std::span<const float> ReadErrors() const override { return read_errors_; }
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
  // Not computed: CHECKs. An algorithm with such operations has Algorithm::on_devices = false.
  void OnHost(std::span<const Array> inputs, std::span<const Array> outputs,
              const HostOperation& operation) override;
  void Mean(Array values, Number mean) override;

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
  // Flags and numbers, which one CopyOut returns after each update.
  struct Results {
    static constexpr size_t kMostNumbers = 512;
    kernels::Flags flags;
    double numbers[kMostNumbers];
  };
  // The results of an update in flight, in host memory.
  struct Slot {
    Results* results;
    float* errors;  // (B)
    bool has_errors;
    std::unique_ptr<Event> arrived;
  };

  int rows() const { return modules_.batch; }
  int ColumnsOf(Array array) const { return int(array.size() / rows()); }
  size_t IndexOf(Number number) const;
  Landing& landing() { return *landings_[turn_]; }
  // Begins inputs in the landing that was not used last.
  void BeginInputs();
  void SetHostNumbers();
  kernels::BeginUpdate FirstCommand() const;
  void AddEndUpdate();
  void Submit();
  Outcome TakeOutcome();

  // Memory between the kernels of a clipped loss (kernels/clipped_policy.h).
  struct ClippedPolicyMemory {
    double* inverse_sigma = nullptr;  // (A)
    kernels::ClippedPolicyConstants* constants = nullptr;
    double* log_prob_gradient = nullptr;  // (B)
    kernels::ClippedPolicyRows::Terms* partials = nullptr;
  };
  const ClippedPolicyMemory& MemoryOfClippedPolicy(int actions);

  // Mirrors that this engine attaches where there is none yet.
  DeviceParameters& Use(const nn::ParameterSet& set, bool changes, const ParameterLayout* layout);
  DeviceAdam& Use(nn::Adam* optimiser);
  // Arrays of set number `i` of the optimiser, for a step.
  kernels::AdamSet AdamSetOf(const nn::Adam& optimiser, size_t i) const;
  kernels::AdamOptions OptionsOf(const nn::Adam& optimiser) const;

  Device* const device_;
  const size_t in_flight_;
  Workspace workspace_;
  DeviceNetworks networks_;
  nn::ModuleContext modules_;
  nn::Replica alone_;  // draws
  Recordings recordings_;
  Results* const results_;  // in the device's memory
  size_t numbers_ = 0;
  std::map<size_t, double> host_numbers_;  // that the host has set, by index
  std::vector<std::unique_ptr<Landing>> landings_;
  size_t turn_ = 0;

  bool updating_ = false;
  const int32_t* batch_finite_ = nullptr;  // of this update, on the device
  std::vector<nn::Adam*> stepped_;         // in this update

  std::vector<Slot> slots_;
  std::deque<size_t> flying_;       // slots of the updates in flight, oldest first
  Results read_;                    // of the outcome that was returned last
  float* errors_ = nullptr;         // (B), of a critic's loss, in the device's memory
  bool returns_errors_ = false;     // in this update
  std::vector<float> read_errors_;  // of the outcome that was returned last
  int32_t* const counter_;          // of kernels, one after another
  std::map<int, ClippedPolicyMemory> clipped_policies_;  // by the number of actions
};

}  // namespace shoal::learner::device
