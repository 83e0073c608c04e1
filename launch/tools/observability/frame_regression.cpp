// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/observability/frame_regression.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/actor_module.h"
#include "common/nn/adam.h"
#include "common/nn/encoder_module.h"
#include "common/nn/host_memory.h"
#include "common/nn/parallel.h"
#include "common/nn/readout_module.h"
#include "replay_server/core/random_shift.h"

namespace shoal::launch {
namespace {

using nn::Module;

// A readout needs the trunk of a head. It uses the trunk of an actor, whose actions are ignored.
class Network {
 public:
  Network(const Config& config, const ObservationSpec& spec, int labels, nn::Precision precision)
      : context_(precision, config.learner.batch, nn::Threads()),
        encoder_(nn::PlanEncoder(config.network, spec), Module::Use::kTraining, context_),
        head_(nn::PlanActor(config.network, spec), &encoder_.features(), /*trains_encoder=*/true,
              Module::Use::kTraining, context_),
        readout_("readout", labels, *head_.trunk_features(), context_),
        optimiser_({&encoder_.parameters(), &head_.parameters(), &readout_.parameters()},
                   {.rate = config.learner.learning_rate}),
        zeros_(size_t(config.learner.batch) * size_t(spec.action_size)) {
    for (Module* module : Modules()) module->parameters().Initialise(uint64_t(config.seed));
    Refresh();
  }

  // Returns (B, labels).
  std::span<const float> Forward(std::span<const uint8_t> frames, nn::Statistics statistics) {
    encoder_.Forward(nn::HostArray(frames), statistics);
    head_.Forward({});
    return nn::HostValues(readout_.Forward());
  }
  void Step(std::span<const float> gradient) {
    readout_.Backward(nn::HostArray(gradient));
    head_.Backward(nn::HostArray(zeros_), nn::HostArray(zeros_));
    encoder_.Backward();
    optimiser_.Step();
    Refresh();
  }

 private:
  std::vector<Module*> Modules() { return {&encoder_, &head_, &readout_}; }
  void Refresh() {
    for (Module* module : Modules()) module->Refresh();
  }

  const nn::ModuleContext context_;
  nn::EncoderModule encoder_;
  nn::ActorModule head_;
  nn::ReadoutModule readout_;
  nn::Adam optimiser_;
  const std::vector<float> zeros_;  // (B, A)
};

struct Standard {
  std::vector<double> mean, deviation;  // (L)
};

Standard StandardOf(const LabelledFrames& frames, size_t count) {
  const auto labels = size_t(frames.labels);
  Standard standard{std::vector<double>(labels), std::vector<double>(labels)};
  for (size_t i = 0; i < count * labels; ++i) standard.mean[i % labels] += frames.values[i];
  for (double& mean : standard.mean) mean /= double(count);
  for (size_t i = 0; i < count * labels; ++i) {
    const double off = frames.values[i] - standard.mean[i % labels];
    standard.deviation[i % labels] += off * off / double(count);
  }
  // A constant label would be divided by 0.
  for (double& deviation : standard.deviation) deviation = std::max(std::sqrt(deviation), 1e-6);
  return standard;
}

size_t FirstHeldOut(const LabelledFrames& frames) {
  const uint64_t episodes = frames.episodes.empty() ? 0 : frames.episodes.back() + 1;
  if (episodes < 2) {
    throw UsageError("{} frames are {} episode(s); expected samples of at least 2", frames.size(),
                     episodes);
  }
  const uint64_t first = episodes - std::max<uint64_t>(1, episodes / 5);
  return size_t(std::ranges::lower_bound(frames.episodes, first) - frames.episodes.begin());
}

void Train(const Config& config, const LabelledFrames& frames, size_t count,
           const Standard& standard, int updates, const std::function<bool()>& stop,
           Network* network) {
  const ObservationSpec& spec = frames.spec;
  const auto batch = size_t(config.learner.batch), labels = size_t(frames.labels);
  const auto frame_bytes = size_t(spec.FrameBytes());
  std::vector<uint8_t> shifted(batch * frame_bytes);
  std::vector<float> gradient(batch * labels);
  Random random(StreamKey(uint64_t(config.seed), StreamRole::kReplaySampler));
  std::vector<size_t> drawn(batch);
  for (int update = 0; update < updates && !stop(); ++update) {
    for (size_t b = 0; b < batch; ++b) {
      drawn[b] = size_t(random.Uniform() * double(count));
      replay::ShiftPlanes(frames.frame(drawn[b]), spec.channels, spec.height, spec.width,
                          replay::DrawShift(config.replay.shift_pad, &random),
                          shifted.data() + b * frame_bytes);
    }
    const std::span<const float> y = network->Forward(shifted, nn::Statistics::kBatch);
    for (size_t i = 0; i < gradient.size(); ++i) {
      const size_t l = i % labels;
      const double label = (frames.values[drawn[i / labels] * labels + l] - standard.mean[l]) /
                           standard.deviation[l];
      gradient[i] = float(2 * (y[i] - label) / double(gradient.size()));
    }
    network->Step(gradient);
  }
}

}  // namespace

RegressionErrors RegressOnFrames(const Config& config, const LabelledFrames& frames, int updates,
                                 const std::function<bool()>& stop) {
  const nn::ThreadScope scope(nn::Threads());
  const size_t trained = FirstHeldOut(frames), labels = size_t(frames.labels);
  const Standard standard = StandardOf(frames, trained);
  Network network(config, frames.spec, frames.labels,
                  nn::ChoosePrecision(config.learner.precision, /*pixels=*/true));
  Train(config, frames, trained, standard, updates, stop, &network);

  const size_t held_out = frames.size() - trained, batch = size_t(config.learner.batch);
  RegressionErrors errors{.error = std::vector<double>(labels),
                          .of_mean = std::vector<double>(labels),
                          .trained = int(trained),
                          .held_out = int(held_out)};
  // Frames that fill up the last batch are not counted.
  std::vector<uint8_t> batch_frames(batch * size_t(frames.spec.FrameBytes()));
  for (size_t first = trained; first < frames.size(); first += batch) {
    const size_t count = std::min(batch, frames.size() - first);
    std::copy_n(frames.frame(first), count * size_t(frames.spec.FrameBytes()),
                batch_frames.begin());
    const std::span<const float> y = network.Forward(batch_frames, nn::Statistics::kRunning);
    for (size_t i = 0; i < count * labels; ++i) {
      const size_t l = i % labels;
      const double off_mean = frames.values[first * labels + i] - standard.mean[l];
      const double off = y[i] * standard.deviation[l] - off_mean;
      errors.error[l] += off * off / double(held_out);
      errors.of_mean[l] += off_mean * off_mean / double(held_out);
    }
  }
  for (double& error : errors.error) error = std::sqrt(error);
  for (double& error : errors.of_mean) error = std::sqrt(error);
  return errors;
}

}  // namespace shoal::launch
