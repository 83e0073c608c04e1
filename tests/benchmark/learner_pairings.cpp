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

  Of& Get(const std::string& name, const Config& config, const ObservationSpec& spec) {
    if (name == name_) return *agents_;
    agents_.reset();
    agents_ = std::make_unique<Of>(config, spec);
    name_ = name;
    return *agents_;
  }

 private:
  std::string name_;
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
  struct Update {
    std::string name;
    Config config;
    ObservationSpec spec;
  };
  std::vector<Update> updates;
  for (const int batch : {128, 256}) {
    Config config;
    config.learner.batch = batch;
    for (const char* encoder : {"compact", "drq", "mrq", "nature", "spatial_softmax"}) {
      config.network.encoder = encoder;
      updates.push_back({fmt::format("SAC update by two threads, {}, batch {}", encoder, batch),
                         config, PixelSpec()});
    }
    updates.push_back({fmt::format("SAC update by two threads, vectors alone, batch {}", batch),
                       config, VectorSpec()});
    updates.push_back({fmt::format("MR.Q update by two threads, vectors alone, batch {}", batch),
                       LatentModel(batch), VectorSpec()});
  }
  const auto agents = std::make_shared<TwoAgents>();
  std::vector<Pairing> pairings;
  for (const Update& update : updates) {
    const auto get = [agents, update]() -> TwoAgents::Of& {
      return agents->Get(update.name, update.config, update.spec);
    };
    for (const bool busy : {false, true}) {
      pairings.push_back(
          {.stage =
               fmt::format("{}, {}", update.name, busy ? "all cores but one busy" : "idle cores"),
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
