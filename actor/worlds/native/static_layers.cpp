// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/static_layers.h"

#include <algorithm>

namespace shoal::worlds::native {
namespace {

constexpr size_t kMostBytes = 8 << 20;  // for all layers; more would not stay in a core's caches
constexpr size_t kMissesKept = 64;

// Keys are long, and a moving camera has a new one in each frame: four sums side by side. Equal
// hashes of two keys would cost a layer that is not found again, and no bit.
uint64_t HashOf(const StaticLayers::Key& key) {
  constexpr uint64_t kFactor = 0x9e3779b97f4a7c15ULL;
  uint64_t sums[4] = {1, 2, 3, 4};
  size_t i = 0;
  for (; i + 4 <= key.size(); i += 4) {
    for (size_t k = 0; k < 4; ++k) sums[k] = (sums[k] ^ key[i + k]) * kFactor;
  }
  for (; i < key.size(); ++i) sums[0] = (sums[0] ^ key[i]) * kFactor;
  uint64_t hash = key.size();
  for (const uint64_t sum : sums) hash = (hash ^ sum ^ sum >> 32) * kFactor;
  return hash;
}

}  // namespace

const TileBuffer* StaticLayers::Find(const Key& key) const {
  for (const auto& layer : layers_) {
    if (layer->key == key) return &layer->picture;
  }
  return nullptr;
}

bool StaticLayers::Miss(const Key& key) {
  const uint64_t hash = HashOf(key);
  if (std::find(missed_.begin(), missed_.end(), hash) != missed_.end()) return true;
  if (missed_.size() < kMissesKept) {
    missed_.push_back(hash);
  } else {
    missed_[next_missed_] = hash;
    next_missed_ = (next_missed_ + 1) % kMissesKept;
  }
  return false;
}

void StaticLayers::Store(const Key& key, const TileBuffer& picture, const View& view) {
  if (picture.bytes() > kMostBytes) return;
  Layer* to = nullptr;
  if ((layers_.size() + 1) * picture.bytes() <= kMostBytes) {
    layers_.push_back(std::make_unique<Layer>());
    to = layers_.back().get();
  } else {
    to = layers_[next_].get();
    next_ = (next_ + 1) % layers_.size();
  }
  to->key = key;
  to->picture.Resize(view);
  to->picture.CopyFrom(picture);
}

}  // namespace shoal::worlds::native
