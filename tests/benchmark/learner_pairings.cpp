// SPDX-License-Identifier: Apache-2.0
// The gain of a second learner thread: on idle cores, and with another program that keeps all cores
// but one busy.
#include <fmt/core.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/base/usable_cores.h"
#include "common/nn/parallel.h"
#include "common/nn/precision.h"
#include "learner/agent/algorithms.h"
#include "tests/benchmark/noise_batch.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

constexpr double kIdleTarget = 1.7, kBusyTarget = 0.85;

// Agents of one thread and of two, of the network that a row asked for last.
class TwoAgents {
 public:
  struct Of {
    Of(const Config& config, const ObservationSpec& spec)
        : noise(config, spec), one(Make(config, spec, 1)), two(Make(config, spec, 2)) {}

    static std::unique_ptr<learner::Agent> Make(const Config& config, const ObservationSpec& spec,
                                                int threads) {
      const int former = nn::Threads();
      nn::SetThreads(threads);
      auto agent = learner::MakeAgent(config, spec, nn::ChoosePrecision("auto", spec.HasPixels()));
      nn::SetThreads(former);
      return agent;
    }

    NoiseBatch noise;
    const std::unique_ptr<learner::Agent> one, two;
  };

  // Pixels with `encoder`; vectors if it is empty.
  Of& Get(const std::string& encoder, int batch) {
    const std::string name = encoder + std::to_string(batch);
    if (name == name_) return *agents_;
    agents_.reset();
    Config config;
    config.learner.batch = batch;
    ObservationSpec spec = PixelSpec();
    if (encoder.empty()) {
      spec.cameras.clear();
      spec.channels = spec.height = spec.width = 0;
      spec.blocks = {{"observation", 13}};
    } else {
      config.network.encoder = encoder;
    }
    agents_ = std::make_unique<Of>(config, spec);
    name_ = name;
    return *agents_;
  }

 private:
  std::string name_ = "none";
  std::unique_ptr<Of> agents_;
};

// Keeps all cores but one busy while it lives.
class BusyCores {
 public:
  BusyCores() {
    for (int i = 1; i < UsableCores(); ++i) {
      threads_.emplace_back([this] {
        while (!over_.load(std::memory_order_relaxed)) {
        }
      });
    }
  }
  ~BusyCores() {
    over_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  BusyCores(const BusyCores&) = delete;
  BusyCores& operator=(const BusyCores&) = delete;

 private:
  std::atomic<bool> over_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace

std::vector<Pairing> LearnerPairings() {
  struct Network {
    const char *encoder, *name;
    int batch;
  };
  const auto agents = std::make_shared<TwoAgents>();
  std::vector<Pairing> pairings;
  for (const auto& [encoder, name, batch] : {Network{"compact", "compact", 128},
                                             {"compact", "compact", 256},
                                             {"drq", "drq", 128},
                                             {"drq", "drq", 256},
                                             {"mrq", "mrq", 128},
                                             {"mrq", "mrq", 256},
                                             {"nature", "nature", 128},
                                             {"nature", "nature", 256},
                                             {"spatial_softmax", "spatial_softmax", 128},
                                             {"spatial_softmax", "spatial_softmax", 256},
                                             {"", "vectors alone", 128},
                                             {"", "vectors alone", 256}}) {
    const auto get = [agents, encoder = std::string(encoder), batch = batch]() -> TwoAgents::Of& {
      return agents->Get(encoder, batch);
    };
    for (const bool busy : {false, true}) {
      pairings.push_back(
          {.stage = fmt::format("SAC update by two threads, {}, batch {}, {}", name, batch,
                                busy ? "all cores but one busy" : "idle cores"),
           .unit = "updates/s",
           .against = "one thread",
           .target = busy ? kBusyTarget : kIdleTarget,
           .ours = [get] { get().two->Update(get().noise.batch); },
           .other = [get] { get().one->Update(get().noise.batch); },
           .meanwhile =
               busy ? [] { return std::static_pointer_cast<void>(std::make_shared<BusyCores>()); }
                    : std::function<std::shared_ptr<void>()>()});
    }
  }
  return pairings;
}

}  // namespace shoal::bench
