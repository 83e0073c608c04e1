// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/static_layers.h"

#include <algorithm>

#include "common/base/random.h"

namespace shoal::worlds::native {
namespace {

constexpr size_t kMostBytes = 8 << 20;  // for all layers; more would not stay in a core's caches
constexpr size_t kMissesKept = 64;

}  // namespace

const TileBuffer* StaticLayers::Find(const Key& key) const {
  for (const auto& layer : layers_) {
    if (layer->key == key) return &layer->picture;
  }
  return nullptr;
}

bool StaticLayers::Miss(const Key& key) {
  const uint64_t hash = HashBytes(reinterpret_cast<const char*>(key.data()), key.size() * 4);
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
