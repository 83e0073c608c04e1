#include <fmt/core.h>

#include <memory>
#include <string>

#include "common/nn/policy.h"
#include "learner/agent/algorithms.h"
#include "tests/benchmark/noise_batch.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

constexpr int kActors = 4;  // environments of one actor

// A batch of noise and agents of both precisions that learn from it.
struct Learners {
  Learners(const Config& with, const ObservationSpec& seen) : config(with), spec(seen) {}

  Config config;
  ObservationSpec spec;
  NoiseBatch noise{config, spec};
  BatchView batch = noise.batch;
  std::unique_ptr<learner::Agent> automatic =
      learner::MakeAgent(config, spec, nn::ChoosePrecision("auto", /*pixels=*/true));
  std::unique_ptr<learner::Agent> f32 = learner::MakeAgent(config, spec, nn::Precision::kF32);
};

// Large networks one at a time: made when a row asks for them, in the place of the row's before.
class LargeLearners {
 public:
  Learners& Of(const std::string& encoder, int batch, int channels) {
    if (!learners_ || learners_->config.network.encoder != encoder ||
        learners_->config.learner.batch != batch) {
      learners_.reset();
      Config config;
      config.network.encoder = encoder;
      config.learner.batch = batch;
      learners_ = std::make_unique<Learners>(config, PixelSpec(channels));
    }
    return *learners_;
  }

 private:
  std::unique_ptr<Learners> learners_;
};

struct Policies {
  ObservationSpec spec = PixelSpec();
  nn::Policy together{NetworkConfig(), spec, nn::ChoosePrecision("auto", /*pixels=*/true), kActors};
  nn::Policy alone{NetworkConfig(), spec, nn::ChoosePrecision("auto", /*pixels=*/true), 1};
  std::vector<uint8_t> frames = std::vector<uint8_t>(size_t(kActors) * spec.FrameBytes(), 100);
};

}  // namespace

std::vector<Pairing> NetworkPairings() {
  const auto learners = std::make_shared<Learners>(Config(), PixelSpec());
  const auto policies = std::make_shared<Policies>();
  std::vector<Pairing> pairings{
      {.stage = "SAC update, batch 128 of (6, 84, 84), precision auto",
       .unit = "updates/s",
       .against = "precision f32",
       .ours = [learners] { learners->automatic->Update(learners->batch); },
       .other = [learners] { learners->f32->Update(learners->batch); }},
      {.stage = "policy for 4 environments at once",
       .unit = "actions/s",
       .against = "one by one",
       .units_per_call = kActors,
       .ours =
           [policies] { policies->together.Forward(kActors, policies->frames.data(), nullptr); },
       .other =
           [policies] {
             for (int e = 0; e < kActors; ++e) {
               policies->alone.Forward(
                   1, policies->frames.data() + size_t(e) * policies->spec.FrameBytes(), nullptr);
             }
           }}};
  const auto large = std::make_shared<LargeLearners>();
  constexpr int kChannels = 4;  // grey, a stack of four
  for (const char* encoder : {"resnet18", "alexnet"}) {
    for (const int batch : {4, 128}) {
      const auto get = [=]() -> Learners& { return large->Of(encoder, batch, kChannels); };
      pairings.push_back(
          {.stage = fmt::format("SAC update, {}, batch {} of ({}, 84, 84), precision auto", encoder,
                                batch, kChannels),
           .unit = "updates/s",
           .against = "precision f32",
           .ours = [get] { get().automatic->Update(get().batch); },
           .other = [get] { get().f32->Update(get().batch); }});
    }
  }
  return pairings;
}

}  // namespace shoal::bench
