// SPDX-License-Identifier: Apache-2.0
// Finished pictures of what does not move, to draw the rest over.
//
// A layer is found by everything it depends on, so that a picture is the same
// with and without it. Worlds that share a renderer and differ in a goal each
// get their own.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "actor/worlds/native/tile_buffer.h"

namespace shoal::worlds::native {

class StaticLayers {
 public:
  // Words of whatever a layer depends on.
  using Key = std::vector<uint32_t>;

  // The layer with this key; null = none.
  const TileBuffer* Find(const Key& key) const;
  // True when this key was missed lately: it is worth a layer.
  bool Miss(const Key& key);
  void Store(const Key& key, const TileBuffer& picture, const View& view);

 private:
  struct Layer {
    Key key;
    TileBuffer picture;
  };

  std::vector<std::unique_ptr<Layer>> layers_;
  size_t next_ = 0;  // to be replaced
  std::vector<uint64_t> missed_;
  size_t next_missed_ = 0;
};

}  // namespace shoal::worlds::native
