// SPDX-License-Identifier: Apache-2.0
// Material, light and texture of a geom of the engine's abstract scene, for the
// kernels.
#pragma once

#include <span>
#include <vector>

#include "actor/worlds/native/camera_frame.h"
#include "actor/worlds/native/frame_job.h"
#include "actor/worlds/native/plane_grids.h"
#include "actor/worlds/native/shape_setup.h"
#include "actor/worlds/native/triangle_meshes.h"

struct mjvGeom_;
struct mjvScene_;

namespace shoal::worlds::native {

// A scene's lights in camera coordinates. Lights that cast shadows are last, because the engine
// adds each of these in a separate pass. Shadows are left out.
class SceneLights {
 public:
  SceneLights(const mjvScene_& scene, const CameraFrame& frame);

  LightSet set() const { return {static_cast<int>(lights_.size()), lights_.data()}; }
  // Appends to `colours` the colours of each light on the geom's material.
  void AddColours(const mjvGeom_& geom, std::vector<LightColour>* colours) const;
  // Ambient light of all points and normals. If a scene has no lights, the engine adds a little
  // ambient light.
  float global_ambient() const { return lights_.empty() ? 0.3f : 0.0f; }
  std::span<const Light> lights() const { return lights_; }

 private:
  std::vector<Light> lights_;
  std::vector<LightColour> plain_;  // of a white material
};

// Data that the surfaces of a frame refer to; must outlive the surfaces.
struct SurfaceSources {
  const SceneLights* lights;
  std::span<const Texture* const> textures;  // of the model, by number
  PlaneGrids* grids;
  const TriangleMesh* mesh;  // the geom's; null = it is no mesh
  uint32_t stamp;            // of the frame
};

// Appends the surfaces of a shape, one for each colour rule. `colours`: colours of the geom, one
// for each light; their memory must not move.
void AddSurfaces(const mjvGeom_& geom, const PlacedGeom& placed, const Shape& shape,
                 const SurfaceSources& sources, LightColour* colours, bool transparent,
                 std::vector<Surface>* surfaces);

}  // namespace shoal::worlds::native
