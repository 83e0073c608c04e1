// SPDX-License-Identifier: Apache-2.0
// Removal of geoms that a scene's camera cannot see.
#pragma once

struct mjvScene_;

namespace shoal::worlds {

// Removes geoms outside one of the view's planes, fully transparent geoms, and sites inside opaque
// boxes. The scene's camera must be set. Primitive shapes are tested by exact bounds, other geoms
// by a bounding sphere; planes and geoms without a known bound are kept. The picture does not
// change as long as no geom casts shadows or reflects. `aspect`: width / height of the picture.
void RemoveUnseenGeoms(mjvScene_* scene, float aspect);

}  // namespace shoal::worlds
