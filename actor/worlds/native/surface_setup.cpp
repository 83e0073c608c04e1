// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/surface_setup.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "common/base/check.h"

namespace shoal::worlds::native {
namespace {

constexpr double kMostExponent = 128;  // at shininess 1
// If a grid is finer, lighting each pixel is cheaper and equally exact.
constexpr int kMostGridCells = 64 * 64;

void Write(Vector3 v, float* to) {
  to[0] = static_cast<float>(v.x);
  to[1] = static_cast<float>(v.y);
  to[2] = static_cast<float>(v.z);
}

// axes * (p, 1) = scale * axis . (p - centre) + offset
void WriteAxes(Vector3 axis, Vector3 centre, double scale, double offset, float* to) {
  Write(scale * axis, to);
  to[3] = static_cast<float>(offset - scale * Dot(axis, centre));
}

// Cosine to 1e-7. The steps are the same on every platform, so the result is, too.
double CosineOfDegrees(double degrees) {
  const double half = degrees * (3.14159265358979323846 / 360);
  const double s = half * half;
  // sin(half) by its series, for half <= pi / 2. Then cos = 1 - 2 sin^2(half).
  const double sine =
      half *
      (1 - s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110 * (1 - s / 156))))));
  return 1 - 2 * sine * sine;
}

Light MakeLight(const mjvLight& from, const CameraFrame& frame) {
  Light light{};
  light.directional = from.directional;
  light.own_pass = from.castshadow;
  const Vector3 direction = Normalized(frame.Direction(FromFloats(from.dir)));
  if (from.headlight) {
    // The engine puts a headlight at the camera.
    Write({0, 0, -1}, light.direction);
    light.directional = true;
    return light;
  }
  Write(from.directional ? -1 * direction : direction, light.direction);
  Write(frame.Point(FromFloats(from.pos)), light.position);
  std::copy(from.attenuation, from.attenuation + 3, light.attenuation);
  light.exponent = from.exponent;
  light.cutoff_cosine =
      from.cutoff > 90 ? -1 : static_cast<float>(CosineOfDegrees(double{from.cutoff}));
  return light;
}

bool IsGrey(const float* rgb) { return rgb[0] == rgb[1] && rgb[1] == rgb[2]; }

bool GreyColours(const mjvGeom& geom, std::span<const LightColour> colours) {
  return IsGrey(geom.rgba) && std::all_of(colours.begin(), colours.end(), [](const auto& colour) {
           return IsGrey(colour.ambient) && IsGrey(colour.diffuse) && IsGrey(colour.specular);
         });
}

// Lights a flat face under directional lights, without specular reflection.
void LightFace(const SceneLights& lights, const LightColour* colours, Surface* s) {
  for (size_t c = 0; c < 3; ++c) {
    double limited = 0, sum = s->emission[c];
    for (size_t i = 0; i < lights.lights().size(); ++i) {
      const Light& light = lights.lights()[i];
      if (light.own_pass && !s->merged_passes) {
        limited += std::min(sum, 1.0);
        sum = 0;
      }
      double facing = 0;
      for (size_t k = 0; k < 3; ++k) facing += double{s->normal[k]} * light.direction[k];
      sum += colours[i].ambient[c] + colours[i].diffuse[c] * std::max(facing, 0.0);
    }
    s->light[c] = static_cast<float>(limited + std::min(sum, 1.0));
  }
}

void SetMaterial(const mjvGeom& geom, const SurfaceSources& sources, LightColour* colours,
                 bool transparent, Surface* s) {
  for (int c = 0; c < 3; ++c) {
    s->emission[c] = (geom.emission + sources.lights->global_ambient()) * geom.rgba[c];
  }
  s->colours = colours;
  s->specular = geom.specular > 0;
  s->merged_passes = transparent;
  s->exponent = static_cast<float>(double{geom.shininess} * kMostExponent);
  s->exponent *= 0.5f;  // kernels use the squared cosine
  // x^e <= exp(e * (x - 1)). Below least_shine the bound is under 1e-3, a quarter of a grey level.
  s->least_shine = std::max(0.0f, 1 - 7 / std::max(s->exponent, 1.0f));
  s->whole_exponent = -1;
  if (s->exponent >= 0 && s->exponent <= kMostExponent) {
    const auto whole = static_cast<int>(s->exponent);
    if (static_cast<float>(whole) == s->exponent) s->whole_exponent = whole;
  }
  s->stamp = sources.stamp;
}

void SetTexture(const mjvGeom& geom, const PlacedGeom& placed, const SurfaceSources& sources,
                Surface* s) {
  if (geom.texid < 0 || static_cast<size_t>(geom.texid) >= sources.textures.size()) return;
  s->texture = sources.textures[static_cast<size_t>(geom.texid)];
  // Vertices in the engine have unit size, except those of planes, meshes and height fields of the
  // model.
  const bool in_units = geom.dataid >= 0;
  const auto object_scale = [&](size_t k) {
    return in_units || placed.size[k] <= 0 ? 1 : 1 / placed.size[k];
  };
  if (!s->texture->cube) {
    s->mapping = kMap2d;
    for (size_t k = 0; k < 2; ++k) {
      double scale = geom.texrepeat[k];
      if (in_units && placed.size[k] > 0) scale /= placed.size[k];
      if (geom.texuniform && placed.size[k] > 0) scale *= placed.size[k];
      WriteAxes(placed.axes[k], placed.centre, (k == 0 ? 0.5 : -0.5) * scale * object_scale(k),
                -0.5, s->texture_axes[k]);
    }
    return;
  }
  s->mapping = kMapCube;
  for (size_t k = 0; k < 3; ++k) {
    const double scale = geom.texuniform ? placed.size[k] : 1;
    WriteAxes(placed.axes[k], placed.centre, scale * object_scale(k), 0, s->texture_axes[k]);
  }
  if (geom.type == mjGEOM_CAPSULE) {
    // The caps are half spheres. Their own coordinates begin with 0 at half - radius.
    const double radius = placed.size[0], half = placed.size[2];
    const double side_scale = (geom.texuniform ? half : 1) / half;
    s->capsule_caps = true;
    s->cap_scale = static_cast<float>(half / radius);
    s->cap_offset = static_cast<float>(side_scale * (half - radius));
    s->half_length = static_cast<float>(half);
  }
}

// The middle of a face. Faces are numbered as in shape_setup.cpp.
Vector3 FacePoint(const mjvGeom& geom, const PlacedGeom& placed, int face) {
  if (geom.type == mjGEOM_PLANE) return placed.centre;
  if (geom.type == mjGEOM_CYLINDER) {
    return placed.centre + (face == 1 ? placed.size[2] : -placed.size[2]) * placed.axes[2];
  }
  const auto axis = static_cast<size_t>(face / 2);
  return placed.centre + (face % 2 == 0 ? -1 : 1) * placed.size[axis] * placed.axes[axis];
}

void SetGrid(const mjvGeom& geom, const PlacedGeom& placed, const SurfaceSources& sources,
             Surface* s) {
  if (geom.dataid < 0 || geom.dataid >= sources.grids->size()) return;
  const PlaneGrid& grid = *sources.grids->grid(geom.dataid);
  if (grid.cells[0] * grid.cells[1] > kMostGridCells) return;
  s->grid = sources.grids->grid(geom.dataid);
  const size_t lights = sources.lights->lights().size();
  s->grey_grid = GreyColours(geom, {s->colours, lights});
  Write(placed.centre, s->centre);
  for (size_t k = 0; k < 2; ++k) {
    Write(placed.axes[k], s->grid_directions[k]);
    WriteAxes(placed.axes[k], placed.centre, 1, 0, s->grid_axes[k]);
  }
}

void SetMesh(const mjvGeom& geom, const PlacedGeom& placed, const Shape& shape,
             const TriangleMesh& mesh, Surface* s) {
  s->normal_kind = kMeshNormals;
  s->mesh.triangles = shape.triangle;
  s->mesh.normals = mesh.normals.data();
  if (geom.texcoord && s->texture != nullptr && !mesh.coords.empty()) {
    s->mesh.coords = mesh.coords.data();
    s->mapping = kMap2d;
  }
  for (size_t k = 0; k < 3; ++k) Write(placed.axes[k], s->mesh.axes[k]);
}

// Sets the normals of spheres and ellipsoids, and of the sides of cylinders and capsules.
void SetRoundNormals(const mjvGeom& geom, const PlacedGeom& placed, Surface* s) {
  const auto& size = placed.size;
  s->inverse_radius = static_cast<float>(1 / size[0]);
  if (geom.type == mjGEOM_CYLINDER || geom.type == mjGEOM_CAPSULE) {
    s->normal_kind = kRod;
    s->half_length = static_cast<float>(size[2]);
    return;
  }
  if (size[0] == size[1] && size[1] == size[2]) {
    s->normal_kind = kRound;
    return;
  }
  s->normal_kind = kOval;
  for (size_t row = 0; row < 3; ++row) {
    Vector3 sum;
    for (size_t k = 0; k < 3; ++k) {
      const Vector3& axis = placed.axes[k];
      const double of_row = row == 0 ? axis.x : row == 1 ? axis.y : axis.z;
      sum = sum + of_row / (size[k] * size[k]) * axis;
    }
    Write(sum, s->gram + 3 * row);
  }
}

}  // namespace

SceneLights::SceneLights(const mjvScene& scene, const CameraFrame& frame) {
  const int count = std::min(scene.nlight, mjMAXLIGHT);
  lights_.reserve(static_cast<size_t>(count));
  plain_.reserve(static_cast<size_t>(count));
  for (const bool casts : {false, true}) {
    for (int i = 0; i < count; ++i) {
      const mjvLight& from = scene.lights[i];
      if ((from.castshadow != 0) != casts) continue;
      Light light = MakeLight(from, frame);
      LightColour colour;
      std::copy(from.ambient, from.ambient + 3, colour.ambient);
      std::copy(from.diffuse, from.diffuse + 3, colour.diffuse);
      std::copy(from.specular, from.specular + 3, colour.specular);
      light.specular =
          std::any_of(from.specular, from.specular + 3, [](float channel) { return channel > 0; });
      lights_.push_back(light);
      plain_.push_back(colour);
    }
  }
}

void SceneLights::AddColours(const mjvGeom& geom, std::vector<LightColour>* colours) const {
  for (LightColour colour : plain_) {
    for (int c = 0; c < 3; ++c) {
      colour.ambient[c] *= geom.rgba[c];
      colour.diffuse[c] *= geom.rgba[c];
      colour.specular[c] *= geom.specular;
    }
    colours->push_back(colour);
  }
}

void AddSurfaces(const mjvGeom& geom, const PlacedGeom& placed, const Shape& shape,
                 const SurfaceSources& sources, LightColour* colours, bool transparent,
                 std::vector<Surface>* surfaces) {
  Surface base{};
  base.id = shape.id;
  base.rect = shape.rect;
  SetMaterial(geom, sources, colours, transparent, &base);
  Write(placed.centre, base.centre);
  Write(placed.axes[2], base.axis);
  SetTexture(geom, placed, sources, &base);

  const std::span<const Light> lights = sources.lights->lights();
  const bool shines = base.specular && std::any_of(lights.begin(), lights.end(),
                                                   [](const Light& l) { return l.specular; });
  base.specular = shines;
  const bool all_directional = std::all_of(lights.begin(), lights.end(),
                                           [](const Light& light) { return light.directional; });
  const auto add_flat = [&](int face, Vector3 normal) {
    Surface s = base;
    s.id = shape.id + face;
    s.normal_kind = kFlat;
    Write(normal, s.normal);
    const double distance = Dot(normal, FacePoint(geom, placed, face));
    s.turn[0] = static_cast<float>(normal.x / distance);
    s.turn[1] = static_cast<float>(normal.y / distance);
    s.one_light = !shines && all_directional;
    if (s.one_light) LightFace(*sources.lights, colours, &s);
    if (geom.type == mjGEOM_PLANE && !s.one_light) SetGrid(geom, placed, sources, &s);
    // Planes alone are large enough to gain from it. A shine without a least value is everywhere.
    s.one_dull_light = geom.type == mjGEOM_PLANE && shines && all_directional &&
                       s.grid == nullptr && s.least_shine > 0;
    surfaces->push_back(s);
  };
  if (geom.type == mjGEOM_PLANE) return add_flat(0, placed.axes[2]);
  const bool box = geom.type == mjGEOM_BOX;
  if (box || geom.type == mjGEOM_CYLINDER) {
    for (const int face : std::span(shape.faces, static_cast<size_t>(shape.enters))) {
      const bool positive = box ? face % 2 == 1 : face == 1;
      const size_t axis = box ? static_cast<size_t>(face / 2) : 2;
      add_flat(face, (positive ? 1.0 : -1.0) * placed.axes[axis]);
    }
  }
  if (box) return;
  if (sources.mesh != nullptr) {
    SetMesh(geom, placed, shape, *sources.mesh, &base);
  } else {
    SetRoundNormals(geom, placed, &base);
  }
  surfaces->push_back(base);
}

}  // namespace shoal::worlds::native
