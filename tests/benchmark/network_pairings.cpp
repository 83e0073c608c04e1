#include <algorithm>
#include <cstdlib>
#include <memory>

#include "common/base/random.h"
#include "common/nn/policy.h"
#include "learner/agent/algorithms.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

constexpr int kActors = 4;  // environments of one actor

ObservationSpec PixelSpec() {
  ObservationSpec spec;
  spec.task = "bench";
  spec.cameras = {"front", "side"};
  spec.channels = 6;
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
  ObservationSpec spec = PixelSpec();
  BatchSchema schema{spec, {.batch = config.learner.batch}};
  std::unique_ptr<uint8_t, Free> memory{
      static_cast<uint8_t*>(std::aligned_alloc(64, schema.total_bytes()))};
  BatchView batch = schema.View(memory.get());
  std::unique_ptr<learner::Agent> automatic =
      learner::MakeAgent(config, spec, nn::ChoosePrecision("auto", /*pixels=*/true));
  std::unique_ptr<learner::Agent> f32 = learner::MakeAgent(config, spec, nn::Precision::kF32);

  Learners() {
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

struct Policies {
  ObservationSpec spec = PixelSpec();
  nn::Policy together{NetworkConfig(), spec, nn::ChoosePrecision("auto", /*pixels=*/true), kActors};
  nn::Policy alone{NetworkConfig(), spec, nn::ChoosePrecision("auto", /*pixels=*/true), 1};
  std::vector<uint8_t> frames = std::vector<uint8_t>(size_t(kActors) * spec.FrameBytes(), 100);
};

}  // namespace

std::vector<Pairing> NetworkPairings() {
  const auto learners = std::make_shared<Learners>();
  const auto policies = std::make_shared<Policies>();
  return {
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
}

}  // namespace shoal::bench
