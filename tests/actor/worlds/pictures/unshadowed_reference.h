// SPDX-License-Identifier: Apache-2.0
// The engine's own OpenGL renderer, set up as for quality `reference` but without shadows,
// reflections and multisampling. Quality `native` should give the same pictures.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

struct mjModel_;
struct mjvScene_;

namespace shoal::worlds::native {

class UnshadowedReference {
 public:
  UnshadowedReference(mjModel_* model, int width, int height);
  ~UnshadowedReference();
  UnshadowedReference(const UnshadowedReference&) = delete;
  UnshadowedReference& operator=(const UnshadowedReference&) = delete;

  // Returns the picture (3, H, W), row 0 = top.
  std::vector<uint8_t> Draw(mjvScene_* scene);
  // Returns for each pixel (H, W) mjvGeom::segid of the front geom; -1 = no geom.
  std::vector<int> DrawSegments(mjvScene_* scene);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shoal::worlds::native
