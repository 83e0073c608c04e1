// SPDX-License-Identifier: Apache-2.0
// Limits of dividing an update among N replicas, for any number of cores here: the parts of N
// replicas run one after another on one thread, compared with the whole update by one replica. The
// ratio is the efficiency of N threads on N cores without cost of barriers and of access to shared
// memory.
#include <fmt/core.h>

#include <memory>
#include <string>

#include "tests/benchmark/lone_replica.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

constexpr int kUpdatesOfACall = 2;  // of a call: one of them moves the actor
constexpr int kDividedBatch = 128;
constexpr double kTarget8 = 0.75, kTarget16 = 0.6;

// One replica, and N of them, of the network that a row asked for last.
class LatestLoneReplicas {
 public:
  struct Of {
    Of(const std::string& network, int count)
        : one(network, kDividedBatch, 1), several(network, kDividedBatch, count) {}

    LoneReplica one, several;
  };

  Of& Get(const std::string& network, int count) {
    const std::string name = fmt::format("{} {}", network, count);
    if (name == name_) return *of_;
    of_.reset();
    of_ = std::make_unique<Of>(network, count);
    name_ = name;
    return *of_;
  }

 private:
  std::string name_;
  std::unique_ptr<Of> of_;
};

void UpdateAll(LoneReplica* replicas) {
  for (int i = 0; i < kUpdatesOfACall; ++i) {
    for (int rank = 0; rank < replicas->replicas(); ++rank) replicas->Update(rank);
  }
}

}  // namespace

std::vector<Pairing> ScalingPairings() {
  std::vector<Pairing> pairings;
  const auto latest = std::make_shared<LatestLoneReplicas>();
  for (const std::string network : {"compact", "spatial_softmax"}) {
    for (const int count : {2, 8, 16, 32}) {
      const auto get = [=]() -> LatestLoneReplicas::Of& { return latest->Get(network, count); };
      pairings.push_back({.stage = fmt::format(
                              "scaling: an update by {} replicas, one after another, {}, batch {}",
                              count, network, kDividedBatch),
                          .unit = "updates/s",
                          .against = "by one thread",
                          .units_per_call = kUpdatesOfACall,
                          .target = count == 8    ? kTarget8
                                    : count == 16 ? kTarget16
                                                  : 0,
                          .ours = [get] { UpdateAll(&get().several); },
                          .other = [get] { UpdateAll(&get().one); }});
    }
  }
  return pairings;
}

}  // namespace shoal::bench
