// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/low_poly_shapes.h"

#include <mujoco/mujoco.h>

#include <array>
#include <cmath>
#include <vector>

#include "actor/worlds/osmesa_library.h"
#include "common/base/check.h"

namespace shoal::worlds {
namespace {

struct Vertex {
  std::array<float, 3> position, normal;
};

using Ring = std::vector<Vertex>;

// Makes `slices` vertices around the z axis. elevation_rad: elevation of their normals.
Ring MakeRing(int slices, float radius, float z, float elevation_rad) {
  Ring ring;
  for (int i = 0; i < slices; ++i) {
    const float azimuth =
        2 * static_cast<float>(M_PI) * static_cast<float>(i) / static_cast<float>(slices);
    const float x = std::cos(azimuth), y = std::sin(azimuth), level = std::cos(elevation_rad);
    ring.push_back({{radius * x, radius * y, z}, {level * x, level * y, std::sin(elevation_rad)}});
  }
  return ring;
}

void Emit(const Vertex& vertex) {
  Osmesa().normal(vertex.normal.data());
  Osmesa().vertex(vertex.position.data());
}

void Triangle(const Vertex& a, const Vertex& b, const Vertex& c) {
  Emit(a);
  Emit(b);
  Emit(c);
}

// Draws the surface between two rings.
void Band(const Ring& lower, const Ring& upper) {
  for (size_t i = 0; i < lower.size(); ++i) {
    const size_t next = (i + 1) % lower.size();
    Triangle(lower[i], lower[next], upper[next]);
    Triangle(lower[i], upper[next], upper[i]);
  }
}

// Draws the ring's plane, visible from above (up = 1) or from below (-1).
void FlatCap(const Ring& ring, int up) {
  for (size_t i = 1; i + 1 < ring.size(); ++i) {
    up > 0 ? Triangle(ring[0], ring[i], ring[i + 1]) : Triangle(ring[0], ring[i + 1], ring[i]);
  }
}

// Draws half a unit sphere whose equator is at z.
void RoundCap(int slices, float z, int up) {
  const float sign = static_cast<float>(up), tilt = sign * static_cast<float>(M_PI) / 4;
  const Ring equator = MakeRing(slices, 1, z, 0);
  const Ring middle = MakeRing(slices, std::cos(tilt), z + std::sin(tilt), tilt);
  const Vertex pole{{0, 0, z + sign}, {0, 0, sign}};
  up > 0 ? Band(equator, middle) : Band(middle, equator);
  for (size_t i = 0; i < middle.size(); ++i) {
    const size_t next = (i + 1) % middle.size();
    up > 0 ? Triangle(middle[i], middle[next], pole) : Triangle(middle[next], middle[i], pole);
  }
}

template <typename Draw>
uint32_t Compile(Draw draw) {
  const OsmesaLibrary& gl = Osmesa();
  const uint32_t list = gl.gen_lists(1);
  CHECK(list != 0) << "no display list: no current context?";
  gl.new_list(list, GL_COMPILE);
  gl.begin(GL_TRIANGLES);
  draw();
  gl.end();
  gl.end_list();
  return list;
}

// Turns the geom into a mesh that draws the given list, scaled along the geom's axes.
void TurnIntoMesh(const mjrContext& context, uint32_t list, float radius, float along,
                  mjvGeom* geom) {
  // The engine draws a mesh as display list baseMesh + dataid.
  CHECK(list >= context.baseMesh) << list << " " << context.baseMesh;
  geom->type = mjGEOM_MESH;
  geom->dataid = static_cast<int>(list - context.baseMesh);
  for (int row = 0; row < 3; ++row) {
    geom->mat[3 * row] *= radius;
    geom->mat[3 * row + 1] *= radius;
    geom->mat[3 * row + 2] *= along;
  }
}

}  // namespace

LowPolyShapes::LowPolyShapes(int slices) : slices_(slices) { CHECK(slices >= 3) << slices; }

uint32_t LowPolyShapes::Cylinder() {
  if (cylinder_ == 0) {
    cylinder_ = Compile([this] {
      constexpr float kUp = static_cast<float>(M_PI) / 2;
      Band(MakeRing(slices_, 1, -1, 0), MakeRing(slices_, 1, 1, 0));
      FlatCap(MakeRing(slices_, 1, -1, -kUp), -1);
      FlatCap(MakeRing(slices_, 1, 1, kUp), 1);
    });
  }
  return cylinder_;
}

uint32_t LowPolyShapes::Capsule(float half_length) {
  uint32_t& list = capsules_[half_length];
  if (list == 0) {
    list = Compile([this, half_length] {
      Band(MakeRing(slices_, 1, -half_length, 0), MakeRing(slices_, 1, half_length, 0));
      RoundCap(slices_, -half_length, -1);
      RoundCap(slices_, half_length, 1);
    });
  }
  return list;
}

void LowPolyShapes::Replace(const mjrContext& context, mjvScene* scene) {
  for (int i = 0; i < scene->ngeom; ++i) {
    mjvGeom& geom = scene->geoms[i];
    const float radius = geom.size[0];
    if (geom.texid >= 0 || geom.size[1] != radius || radius <= 0) continue;
    if (geom.type == mjGEOM_CYLINDER) {
      TurnIntoMesh(context, Cylinder(), radius, geom.size[2], &geom);
    } else if (geom.type == mjGEOM_CAPSULE) {
      TurnIntoMesh(context, Capsule(geom.size[2] / radius), radius, radius, &geom);
    }
  }
}

}  // namespace shoal::worlds
