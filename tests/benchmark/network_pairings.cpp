// SPDX-License-Identifier: Apache-2.0
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

// Networks one at a time: made when a row asks for them, in the place of the row's before.
class LatestLearners {
 public:
  Learners& Of(const std::string& name, const Config& config, int channels) {
    if (!learners_ || name_ != name) {
      learners_.reset();
      learners_ = std::make_unique<Learners>(config, PixelSpec(channels));
      name_ = name;
    }
    return *learners_;
  }

 private:
  std::string name_;
  std::unique_ptr<Learners> learners_;
};

Config WithEncoder(const std::string& encoder, int batch) {
  Config config;
  config.network.encoder = encoder;
  config.learner.batch = batch;
  return config;
}

// SAC from pixels as Stable-Baselines3 has it (preset sb3-nature): encoders of the actor's, the
// critic's and the target's own, or one in their place.
Config LikeStableBaselines(bool three_encoders) {
  Config config = WithEncoder("nature", 256);
  config.network.encoders = three_encoders ? "separate" : "shared";
  config.network.target_encoder = three_encoders;
  config.network.features = 256;
  config.network.layer_norm = false;
  config.network.log_std = "clamped";
  config.learner.actor_period = 1;
  return config;
}

struct Policies {
  ObservationSpec spec = PixelSpec();
  nn::Policy together{NetworkConfig(), spec, nn::ChoosePrecision("auto", /*pixels=*/true), kActors};
  nn::Policy alone{NetworkConfig(), spec, nn::ChoosePrecision("auto", /*pixels=*/true), 1};
  std::vector<uint8_t> frames = std::vector<uint8_t>(size_t(kActors) * spec.FrameBytes(), 100);
};

}  // namespace

std::vector<Pairing> NetworkPairings() {
  const auto latest = std::make_shared<LatestLearners>();
  // An update of automatic precision beside one of f32. `name`: of the network and its batch.
  const auto update = [latest](const std::string& name, const Config& config, int channels) {
    const std::string stage =
        fmt::format("SAC update, {} of ({}, 84, 84), precision auto", name, channels);
    const auto get = [=]() -> Learners& { return latest->Of(name, config, channels); };
    return Pairing{.stage = stage,
                   .unit = "updates/s",
                   .against = "precision f32",
                   .ours = [get] { get().automatic->Update(get().batch); },
                   .other = [get] { get().f32->Update(get().batch); }};
  };
  const auto policies = std::make_shared<Policies>();
  std::vector<Pairing> pairings{
      update("batch 128", Config(), 6),
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
  for (const bool three : {true, false}) {
    pairings.push_back(update(fmt::format("Stable-Baselines3's networks with {}, batch 256",
                                          three ? "its three encoders" : "one encoder"),
                              LikeStableBaselines(three), 3));
  }
  constexpr int kChannels = 4;  // grey, a stack of four
  for (const char* encoder : {"resnet18", "alexnet"}) {
    for (const int batch : {4, 128}) {
      pairings.push_back(update(fmt::format("{}, batch {}", encoder, batch),
                                WithEncoder(encoder, batch), kChannels));
    }
  }
  return pairings;
}

}  // namespace shoal::bench
