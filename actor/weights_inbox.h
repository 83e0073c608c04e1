// The newest weights received, handed from the DDS receive thread to the acting loop.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/base/clock.h"
#include "common/base/mutex.h"
#include "common/wire/messages.h"

namespace shoal::actor {

struct ReceivedWeights {
  WeightsVersion version;
  uint64_t env_steps = 0;
  std::string checkpoint;
  std::string payload;  // safetensors bytes
};

class WeightsInbox {
 public:
  explicit WeightsInbox(uint64_t spec_hash) : spec_hash_(spec_hash) {}

  // Receive thread. Keeps the newest version; weights of another spec or with a wrong CRC are
  // counted and dropped.
  void OnMessage(const WeightsMessage& message);

  // Weights newer than any taken before, if there are any.
  std::optional<ReceivedWeights> TryTake();
  // The same, waiting until `deadline`.
  std::optional<ReceivedWeights> Take(SteadyTime deadline);

  uint64_t refused() const;
  // Versions that a newer one replaced before they were taken.
  uint64_t overtaken() const;

 private:
  std::optional<ReceivedWeights> TakeNewest() SHOAL_REQUIRES(mutex_);

  const uint64_t spec_hash_;
  mutable Mutex mutex_;
  ConditionVariable arrived_;
  std::optional<ReceivedWeights> newest_ SHOAL_GUARDED_BY(mutex_);
  WeightsVersion taken_ SHOAL_GUARDED_BY(mutex_);
  uint64_t refused_ SHOAL_GUARDED_BY(mutex_) = 0, overtaken_ SHOAL_GUARDED_BY(mutex_) = 0;
};

}  // namespace shoal::actor
