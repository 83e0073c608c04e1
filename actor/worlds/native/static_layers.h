// SPDX-License-Identifier: Apache-2.0
// Cache of finished pictures of geoms that do not move. Other geoms are drawn over these layers.
//
// The key of a layer contains everything that the layer depends on, so pictures are the same with
// and without the cache. Worlds that share a renderer and have different goals have different
// layers.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "actor/worlds/native/tile_buffer.h"

namespace shoal::worlds::native {

class StaticLayers {
 public:
  // Words of everything that a layer depends on.
  using Key = std::vector<uint32_t>;

  // The layer with this key; null = none.
  const TileBuffer* Find(const Key& key) const;
  // Records a miss of this key. True if the key was also missed recently; the caller then stores a
  // layer.
  bool Miss(const Key& key);
  void Store(const Key& key, const TileBuffer& picture, const View& view);

 private:
  struct Layer {
    Key key;
    TileBuffer picture;
  };

  std::vector<std::unique_ptr<Layer>> layers_;
  size_t next_ = 0;  // index of the next layer to replace
  std::vector<uint64_t> missed_;
  size_t next_missed_ = 0;
};

}  // namespace shoal::worlds::native
