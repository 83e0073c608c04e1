// SPDX-License-Identifier: Apache-2.0
// Leaves out of a scene what its camera cannot see.
#pragma once

struct mjvScene_;

namespace shoal::worlds {

// Removes geoms that lie outside one of the view's planes, fully transparent ones and sites inside
// opaque boxes from a scene whose camera is set. Primitive shapes are bounded by what they are,
// others by their bounding sphere; planes and geoms without a known bound stay. The picture does
// not change as long as nothing casts shadows or reflects. `aspect`: width / height of the picture.
void RemoveUnseenGeoms(mjvScene_* scene, float aspect);

}  // namespace shoal::worlds
