// SPDX-License-Identifier: Apache-2.0
// The newest received weights, passed from the DDS receive thread to the acting loop.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "common/base/clock.h"
#include "common/base/mutex.h"
#include "common/base/shared_bytes.h"
#include "common/wire/messages.h"
#include "common/wire/weights_parts.h"

namespace shoal::actor {

struct ReceivedWeights {
  WeightsVersion version;
  uint64_t env_steps = 0;
  std::string checkpoint;
  SharedBytes payload;  // safetensors
};

// Source of an acting loop's weights.
class WeightsSource {
 public:
  virtual ~WeightsSource() = default;
  // Returns weights that are newer than all weights taken before, if any. Does not wait.
  virtual std::optional<ReceivedWeights> TryTake() = 0;
};

class WeightsInbox final : public WeightsSource {
 public:
  // `on_newest` is called on the receive thread with each version that is kept, before the version
  // can be taken.
  using OnNewest = std::function<void(const ReceivedWeights&)>;
  explicit WeightsInbox(uint64_t spec_hash, OnNewest on_newest = {})
      : spec_hash_(spec_hash), on_newest_(std::move(on_newest)) {}

  // Called on the receive thread. Keeps the newest complete version. Parts of another spec or with
  // a wrong CRC are counted and dropped.
  void OnMessage(const WeightsPart& part);

  std::optional<ReceivedWeights> TryTake() override;
  // Like TryTake, but waits until `deadline`.
  std::optional<ReceivedWeights> Take(SteadyTime deadline);

  uint64_t refused() const;
  // Number of versions that a newer version replaced before they were taken.
  uint64_t overtaken() const;

 private:
  std::optional<ReceivedWeights> TakeNewest() SHOAL_REQUIRES(mutex_);

  const uint64_t spec_hash_;
  const OnNewest on_newest_;
  mutable Mutex mutex_;
  ConditionVariable arrived_;
  WeightsAssembler assembler_ SHOAL_GUARDED_BY(mutex_);
  std::optional<ReceivedWeights> newest_ SHOAL_GUARDED_BY(mutex_);
  uint64_t refused_ SHOAL_GUARDED_BY(mutex_) = 0, overtaken_ SHOAL_GUARDED_BY(mutex_) = 0;
};

}  // namespace shoal::actor
