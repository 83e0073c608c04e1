#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>

#include "common/base/random.h"
#include "common/nn/policy.h"
#include "learner/agent/algorithms.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

constexpr int kActors = 4;  // environments of one actor

ObservationSpec PixelSpec(int channels = 6) {
  ObservationSpec spec;
  spec.task = "bench";
  spec.cameras = {"front", "side"};
  spec.channels = channels;
  spec.height = spec.width = 84;
  spec.action_size = 4;
  return spec;
}

// A batch of noise and agents of both precisions that learn from it.
struct Learners {
  struct Free {
    void operator()(uint8_t* p) const { std::free(p); }
  };

  Config config;
  ObservationSpec spec;
  BatchSchema schema{spec, {.batch = config.learner.batch}};
  std::unique_ptr<uint8_t, Free> memory{
      static_cast<uint8_t*>(std::aligned_alloc(64, schema.total_bytes()))};
  BatchView batch = schema.View(memory.get());
  std::unique_ptr<learner::Agent> automatic =
      learner::MakeAgent(config, spec, nn::ChoosePrecision("auto", /*pixels=*/true));
  std::unique_ptr<learner::Agent> f32 = learner::MakeAgent(config, spec, nn::Precision::kF32);

  Learners(const Config& with, const ObservationSpec& seen) : config(with), spec(seen) {
    Random random(1);
    const auto fill = [&](auto& array, double low, double high) {
      for (auto& x : array) {
        x = static_cast<std::remove_reference_t<decltype(x)>>(random.Uniform(low, high));
      }
    };
    fill(batch.obs_frames, 0, 256);
    fill(batch.next_obs_frames, 0, 256);
    fill(batch.action, -1, 1);
    fill(batch.reward, -0.3, 0);
    fill(batch.bootstrap, 1, 1);
    fill(batch.weights_update, 0, 1);
  }
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
