// SPDX-License-Identifier: Apache-2.0
// The engine's own OpenGL renderer as quality `reference` sets it up, but without shadows,
// reflections and multisampling: what quality `native` is to look like.
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

  // (3, H, W), row 0 = top.
  std::vector<uint8_t> Draw(mjvScene_* scene);
  // (H, W): mjvGeom::segid of what is in front; -1 = nothing.
  std::vector<int> DrawSegments(mjvScene_* scene);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shoal::worlds::native
