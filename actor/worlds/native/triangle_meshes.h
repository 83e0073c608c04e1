// SPDX-License-Identifier: Apache-2.0
// Triangles with a normal at each corner, for a model's meshes, their convex hulls and height
// fields, like in the engine's renderer.
#pragma once

#include <map>
#include <vector>

#include "actor/worlds/native/camera_frame.h"
#include "actor/worlds/native/frame_job.h"
#include "actor/worlds/native/shape_setup.h"

struct mjModel_;
struct mjvGeom_;

namespace shoal::worlds::native {

// T triangles, in the geom's own coordinates.
struct TriangleMesh {
  std::vector<float> positions;  // (T, 3, 3)
  std::vector<float> normals;    // (T, 3, 3)
  std::vector<float> coords;     // (T, 3, 2) of a texture; empty = none

  int size() const { return static_cast<int>(positions.size() / 9); }
};

class TriangleMeshes {
 public:
  // Copies the meshes and height fields that visible geoms of the model use.
  explicit TriangleMeshes(const mjModel_& model);

  // The triangles of a mesh or height field of the scene; null = not one of the model's.
  const TriangleMesh* Find(const mjvGeom_& geom) const;

 private:
  std::map<int, TriangleMesh> meshes_;   // by mjvGeom::dataid: 2 * mesh, + 1 for its hull
  std::map<int, TriangleMesh> hfields_;  // by mjvGeom::dataid
};

// Fills `shape`, and the triangles of the mesh that face the eye and may be in view. The memory of
// the triangles must not move during the shape's lifetime. False if there are no such triangles.
bool MakeTriangles(const TriangleMesh& mesh, const PlacedGeom& placed, const CameraFrame& frame,
                   const View& view, int id, std::vector<Triangle>* triangles, Shape* shape);

}  // namespace shoal::worlds::native
