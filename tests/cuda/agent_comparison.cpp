// SPDX-License-Identifier: Apache-2.0
#include "tests/cuda/agent_comparison.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <string_view>
#include <thread>

#include "common/base/random.h"
#include "common/nn/safetensors.h"
#include "learner/agent/algorithms.h"
#include "learner/device/device_agent.h"
#include "tests/benchmark/noise_batch.h"

namespace shoal::trial {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr uint64_t kBatches = 4;  // that updates use in turn

bool OnPolicy(const Setting& setting) { return setting.algorithm == "ppo"; }

constexpr int kEpochs = 2, kMinibatches = 2;
BatchOptions OptionsOf(const Setting& setting, int batch) {
  if (!OnPolicy(setting)) return {.batch = batch};
  return {.batch = kMinibatches * batch, .rollout = true};
}

// The bias before a spatial softmax changes no point. Its gradient is a rounding error, which
// Adam's steps enlarge.
std::string_view WithoutEffect(const Setting& setting) {
  return setting.encoder == "spatial_softmax" ? "encoder.conv1.bias" : "";
}

std::vector<float> FloatsOf(const nn::NamedTensor& tensor) {
  std::vector<float> floats(tensor.data.size() / sizeof(float));
  std::memcpy(floats.data(), tensor.data.data(), floats.size() * sizeof(float));
  return floats;
}

// Tensors whose numbers are larger or smaller by one part in 1e7.
nn::TensorMap Shaken(nn::TensorMap tensors, uint64_t seed) {
  Random random(seed);
  for (auto& [name, tensor] : tensors) {
    if (tensor.dtype != "F32") continue;
    std::vector<float> floats = FloatsOf(tensor);
    for (float& x : floats) x = float(x * (1 + (random.Uniform(0, 1) < 0.5 ? 1e-7 : -1e-7)));
    std::memcpy(tensor.data.data(), floats.data(), tensor.data.size());
  }
  return tensors;
}

// Squares of lengths.
struct Change {
  double difference = 0, change = 0;

  double Relative() const {
    if (difference == 0) return 0;
    return std::isfinite(difference) ? std::sqrt(difference / change) : kInfinity;
  }
};

// Tensors of an agent before and after a stretch.
struct Stretch {
  nn::TensorMap before, after;

  // The change of each number of a tensor.
  std::vector<double> ChangeOf(const std::string& name) const {
    const std::vector<float> from = FloatsOf(before.at(name)), to = FloatsOf(after.at(name));
    std::vector<double> change(to.size());
    for (size_t i = 0; i < to.size(); ++i) change[i] = double(to[i]) - double(from[i]);
    return change;
  }
};

// The relative difference of the network whose change differs most (Differences::changes).
double ChangeDifference(const Stretch& ours, const Stretch& theirs,
                        std::string_view without_effect) {
  std::map<std::string, Change> networks;  // "actor", "target"
  for (const auto& [name, tensor] : theirs.after) {
    // The moments of an optimiser are seen in its next step.
    if (tensor.dtype != "F32" || name.starts_with("adam.")) continue;
    if (!without_effect.empty() && name.ends_with(without_effect)) continue;
    const std::vector<double> x = ours.ChangeOf(name), y = theirs.ChangeOf(name);
    Change& network = networks[name.substr(0, name.find('.'))];
    for (size_t i = 0; i < y.size(); ++i) {
      network.difference += (x[i] - y[i]) * (x[i] - y[i]);
      network.change += y[i] * y[i];
    }
  }
  double worst = 0;
  for (const auto& [name, network] : networks) worst = std::max(worst, network.Relative());
  return worst;
}

double FigureDifference(const learner::UpdateOutcome& ours, const learner::UpdateOutcome& theirs) {
  const auto &some = ours.figures.entries(), &other = theirs.figures.entries();
  if (!ours.finite || some.size() != other.size()) return kInfinity;
  double worst = 0;
  for (size_t i = 0; i < other.size(); ++i) {
    if (some[i].figure != other[i].figure || !std::isfinite(some[i].value)) return kInfinity;
    const double difference = std::abs(some[i].value - other[i].value);
    worst = std::max(worst, difference / (1 + std::abs(other[i].value)));
  }
  return worst;
}

// Threads for an agent of the CPU, whose updates take most of the time.
int CpuThreads(const Config& config, const ObservationSpec& spec) {
  const int cores = int(std::max(std::thread::hardware_concurrency(), 1u));
  return learner::ReplicasOf(config, spec, std::min({cores, 8, config.learner.batch}));
}

class Comparison {
 public:
  Comparison(learner::device::Device* device, const Setting& setting, const Schedule& schedule)
      : setting_(setting), schedule_(schedule), itself_(device == nullptr) {
    const Config config = ConfigOf(setting, schedule.batch);
    const ObservationSpec spec = SpecOf(setting);
    for (uint64_t i = 0; i < kBatches; ++i) {
      batches_.push_back(std::make_unique<bench::NoiseBatch>(
          spec, OptionsOf(setting, schedule.batch), /*seed=*/1 + i));
    }
    ours_ = itself_ ? learner::MakeAgent(config, spec, setting.precision)
                    : learner::device::MakeDeviceAgent(config, spec, setting.precision, device);
    nn::SetThreads(CpuThreads(config, spec));
    theirs_ = learner::MakeAgent(config, spec, setting.precision);
    nn::SetThreads(1);
  }

  Differences Run() {
    for (int first = 0; first < schedule_.updates; first += schedule_.every) {
      RunStretch(first);
      for (int u = first + schedule_.stretch; u < first + schedule_.every; ++u) {
        theirs_->Update(BatchOf(u));
      }
    }
    return differences_;
  }

 private:
  const BatchView& BatchOf(int update) const { return batches_[size_t(update) % kBatches]->batch; }

  void RunStretch(int first) {
    Stretch our_stretch, their_stretch;
    their_stretch.before = theirs_->AllTensors();
    our_stretch.before =
        itself_ ? Shaken(their_stretch.before, uint64_t(first)) : their_stretch.before;
    ours_->Restore(our_stretch.before, "the agent of the CPU");
    std::vector<learner::UpdateOutcome> ours, theirs;
    const auto keep = [&](std::vector<learner::UpdateOutcome> known) {
      std::ranges::move(known, std::back_inserter(ours));
    };
    for (int u = first; u < first + schedule_.stretch; ++u) {
      keep(ours_->Submit(BatchOf(u), [](learner::UpdateStage) {}));
      theirs.push_back(theirs_->Update(BatchOf(u)));
    }
    keep(ours_->Finish());
    if (ours.size() != theirs.size()) {  // an update that is not finite removes those behind it
      differences_.changes.push_back(kInfinity);
      return;
    }
    if (first == 0) differences_.figures = FigureDifference(ours.front(), theirs.front());
    our_stretch.after = ours_->AllTensors();
    their_stretch.after = theirs_->AllTensors();
    differences_.changes.push_back(
        ChangeDifference(our_stretch, their_stretch, WithoutEffect(setting_)));
  }

  const Setting setting_;
  const Schedule schedule_;
  const bool itself_;
  std::vector<std::unique_ptr<bench::NoiseBatch>> batches_;
  std::unique_ptr<learner::Agent> ours_, theirs_;
  Differences differences_;
};

}  // namespace

std::string Describe(const Setting& setting) {
  return fmt::format("{}, {}, {}", setting.algorithm,
                     setting.encoder.empty() ? "vectors" : setting.encoder,
                     nn::ToString(setting.precision));
}

Config ConfigOf(const Setting& setting, int batch) {
  Config config;
  config.learner.algorithm = setting.algorithm;
  config.learner.batch = batch;
  config.ppo.epochs = kEpochs;
  config.observation.pixels = !setting.encoder.empty();
  if (!setting.encoder.empty()) config.network.encoder = setting.encoder;
  return config;
}

ObservationSpec SpecOf(const Setting& setting) {
  ObservationSpec spec = bench::PixelSpec();
  spec.drawn_actions = OnPolicy(setting);
  if (!setting.encoder.empty()) return spec;
  spec.cameras.clear();
  spec.channels = 0;
  spec.blocks = {{"state", 10}};
  return spec;
}

double Differences::MedianChange() const {
  std::vector<double> sorted = changes;
  std::ranges::sort(sorted);
  return sorted.at(sorted.size() / 2);
}

double Differences::LargestChange() const { return *std::ranges::max_element(changes); }

Differences CompareUpdates(learner::device::Device* device, const Setting& setting,
                           const Schedule& schedule) {
  return Comparison(device, setting, schedule).Run();
}

}  // namespace shoal::trial
