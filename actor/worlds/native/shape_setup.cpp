// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/shape_setup.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "actor/worlds/native/screen_bounds.h"
#include "common/base/check.h"

namespace shoal::worlds::native {
namespace {

constexpr double kTiny = 1e-12;

// The affine function a . (X, Y, 1), relative to the shape's origin.
Affine MakeAffine(const Shape& shape, Vector3 a) {
  return {static_cast<float>(a.x * shape.x + a.y * shape.y + a.z), static_cast<float>(a.x),
          static_cast<float>(a.y)};
}

double AwayFromZero(double value) {
  if (std::fabs(value) >= kTiny) return value;
  return value < 0 ? -kTiny : kTiny;
}

// The points p with |rows * (p - centre)| = 1. With p = ray / w, they are the roots of g w^2 - 2 h
// w + |rows ray|^2, where g = |rows centre|^2 - 1 and h = rows centre . rows ray. Returns whether
// the eye is outside.
bool MakeQuadric(const Shape& shape, Vector3 centre, const std::array<Vector3, 3>& rows,
                 Quadric* quadric) {
  double g = -1;
  Vector3 h;
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (const Vector3& row : rows) {
    const double at = Dot(row, centre);
    g += at * at;
    h = h + at * row;
    xx += row.x * row.x;
    xy += row.x * row.y;
    xz += row.x * row.z;
    yy += row.y * row.y;
    yz += row.y * row.z;
    zz += row.z * row.z;
  }
  g = AwayFromZero(g);
  const double scale = 1 / g;
  const Vector3 b = scale * h;
  quadric->b = MakeAffine(shape, b);
  // b^2 - (rows ray)^2 / g as a quadratic form of (X, Y, 1), then relative to the origin.
  const double qxx = b.x * b.x - scale * xx, qxy = b.x * b.y - scale * xy;
  const double qxz = b.x * b.z - scale * xz, qyy = b.y * b.y - scale * yy;
  const double qyz = b.y * b.z - scale * yz, qzz = b.z * b.z - scale * zz;
  const double x = shape.x, y = shape.y;
  quadric->d = static_cast<float>(qxx * x * x + 2 * qxy * x * y + qyy * y * y + 2 * qxz * x +
                                  2 * qyz * y + qzz);
  quadric->dx = static_cast<float>(2 * (qxx * x + qxy * y + qxz));
  quadric->dy = static_cast<float>(2 * (qxy * x + qyy * y + qyz));
  quadric->dxx = static_cast<float>(qxx);
  quadric->dxy = static_cast<float>(2 * qxy);
  quadric->dyy = static_cast<float>(qyy);
  return g > 0;
}

std::array<Vector3, 3> InverseRows(const PlacedGeom& geom, double x, double y, double z) {
  return {(1 / x) * geom.axes[0], (1 / y) * geom.axes[1],
          z > 0 ? (1 / z) * geom.axes[2] : Vector3{}};
}

void SetOrigin(const PlacedGeom& geom, const CameraFrame& frame, Shape* shape) {
  shape->x = shape->y = 0;
  if (geom.centre.z < frame.near) return;
  const double x = geom.centre.x / geom.centre.z, y = geom.centre.y / geom.centre.z;
  if (std::fabs(x) > 2 * frame.half_width ||
      std::fabs(y - frame.centre_y) > 2 * frame.half_height) {
    return;
  }
  shape->x = static_cast<float>(x);
  shape->y = static_cast<float>(y);
}

bool MakeEllipsoid(const PlacedGeom& geom, const CameraFrame& frame, const View& view,
                   Shape* shape) {
  shape->kind = kEllipsoid;
  const auto& s = geom.size;
  if (!TilesOf(BoundEllipsoid(geom.centre, geom.axes, s, frame.near), frame, view, &shape->rect)) {
    return false;
  }
  return MakeQuadric(*shape, geom.centre, InverseRows(geom, s[0], s[1], s[2]), &shape->quadric);
}

bool MakeCapsule(const PlacedGeom& geom, const CameraFrame& frame, const View& view, Shape* shape) {
  shape->kind = kCapsule;
  const double radius = geom.size[0], half = geom.size[2];
  const Vector3 ends[2] = {geom.centre + half * geom.axes[2], geom.centre - half * geom.axes[2]};
  const std::array<double, 3> radii{radius, radius, radius};
  const RayRect rect = Union(BoundEllipsoid(ends[0], geom.axes, radii, frame.near),
                             BoundEllipsoid(ends[1], geom.axes, radii, frame.near));
  if (!TilesOf(rect, frame, view, &shape->rect)) return false;
  shape->inside_side =
      !MakeQuadric(*shape, geom.centre, InverseRows(geom, radius, radius, 0), &shape->quadric);
  const double eye = -Dot(geom.axes[2], geom.centre);
  shape->cap = eye > 0 ? 0 : 1;
  shape->z = MakeAffine(*shape, geom.axes[2]);
  shape->z_low = static_cast<float>(-half - eye);
  shape->z_high = static_cast<float>(half - eye);
  bool outside = true;
  for (int i = 0; i < 2; ++i) {
    outside &=
        MakeQuadric(*shape, ends[i], InverseRows(geom, radius, radius, radius), &shape->caps[i]);
  }
  // An eye inside the capsule sees no front.
  return outside && !(shape->inside_side && std::fabs(eye) <= half);
}

// The part between the planes at -half and +half along an axis. Each plane bounds w from below or
// from above by an affine function, depending on the eye's side. `faces`: ids of the faces at -half
// and +half.
void AddSlab(Vector3 centre, Vector3 axis, double half, const int (&faces)[2], Shape* shape) {
  const double middle = Dot(axis, centre);
  for (int i = 0; i < 2; ++i) {
    const double sign = i == 0 ? -1 : 1;
    // sign * axis . (ray - w centre) <= half * w
    const double distance = AwayFromZero(half + sign * middle);
    const Affine bound = MakeAffine(*shape, (sign / distance) * axis);
    if (distance < 0) {  // the eye is beyond this face
      shape->faces[shape->enters] = faces[i];
      shape->enter[shape->enters++] = bound;
    } else {
      shape->leave[shape->leaves++] = bound;
    }
  }
}

bool MakeCylinder(const PlacedGeom& geom, const CameraFrame& frame, const View& view,
                  Shape* shape) {
  shape->kind = kCylinder;
  const double radius = geom.size[0], half = geom.size[2];
  const std::array<double, 3> radii{radius, radius, 0};
  const RayRect rect =
      Union(BoundEllipsoid(geom.centre + half * geom.axes[2], geom.axes, radii, frame.near),
            BoundEllipsoid(geom.centre - half * geom.axes[2], geom.axes, radii, frame.near));
  if (!TilesOf(rect, frame, view, &shape->rect)) return false;
  shape->inside_side =
      !MakeQuadric(*shape, geom.centre, InverseRows(geom, radius, radius, 0), &shape->quadric);
  AddSlab(geom.centre, geom.axes[2], half, {2, 1}, shape);
  return shape->enters > 0 || !shape->inside_side;
}

constexpr std::array<int, 2> kBoxEdges[] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                                            {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

bool MakeBox(const PlacedGeom& geom, const CameraFrame& frame, const View& view, Shape* shape) {
  shape->kind = kBox;
  std::array<Vector3, 8> corners;
  for (size_t i = 0; i < 8; ++i) {
    corners[i] = geom.centre;
    for (size_t k = 0; k < 3; ++k) {
      corners[i] = corners[i] + ((i >> k & 1) ? geom.size[k] : -geom.size[k]) * geom.axes[k];
    }
  }
  if (!TilesOf(BoundHull(corners, kBoxEdges, frame.near), frame, view, &shape->rect)) return false;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<size_t>(k);
    AddSlab(geom.centre, geom.axes[i], geom.size[i], {2 * k, 2 * k + 1}, shape);
  }
  return shape->enters > 0;
}

constexpr std::array<int, 2> kQuadEdges[] = {{0, 1}, {1, 3}, {3, 2}, {2, 0}};

// A size of 0 means an endless plane.
bool MakePlane(const PlacedGeom& geom, const CameraFrame& frame, const View& view, Shape* shape) {
  shape->kind = kPlane;
  const double distance = Dot(geom.axes[2], geom.centre);
  if (std::fabs(distance) < kTiny) return false;  // seen edge on
  RayRect rect{-HUGE_VAL, HUGE_VAL, -HUGE_VAL, HUGE_VAL};
  if (geom.size[0] > 0 && geom.size[1] > 0) {
    std::array<Vector3, 4> corners;
    for (size_t i = 0; i < 4; ++i) {
      corners[i] = geom.centre + ((i & 1) ? geom.size[0] : -geom.size[0]) * geom.axes[0] +
                   ((i & 2) ? geom.size[1] : -geom.size[1]) * geom.axes[1];
    }
    rect = BoundHull(corners, kQuadEdges, frame.near);
  }
  if (!TilesOf(rect, frame, view, &shape->rect)) return false;
  const Vector3 w = (1 / distance) * geom.axes[2];
  shape->faces[0] = 0;
  shape->enter[shape->enters++] = MakeAffine(*shape, w);
  for (size_t k = 0; k < 2; ++k) {
    if (geom.size[k] <= 0) continue;
    const double middle = Dot(geom.axes[k], geom.centre);
    for (const double sign : {-1.0, 1.0}) {
      // half * w - sign * (axis . ray - w * middle) >= 0
      shape->inside[shape->insides++] =
          MakeAffine(*shape, (geom.size[k] + sign * middle) * w - sign * geom.axes[k]);
    }
  }
  return true;
}

}  // namespace

PlacedGeom Place(const mjvGeom& geom, const CameraFrame& frame) {
  PlacedGeom placed;
  placed.centre = frame.Point(FromFloats(geom.pos));
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<size_t>(i);
    placed.axes[k] = frame.Direction(ColumnOf(geom.mat, i));
    placed.size[k] = geom.size[k];
  }
  return placed;
}

bool MakeShape(const mjvGeom& geom, const PlacedGeom& placed, const CameraFrame& frame,
               const View& view, int id, Shape* shape) {
  *shape = Shape{};
  shape->id = id;
  SetOrigin(placed, frame, shape);
  switch (geom.type) {
    case mjGEOM_PLANE:
      return MakePlane(placed, frame, view, shape);
    case mjGEOM_SPHERE:
    case mjGEOM_ELLIPSOID:
      return MakeEllipsoid(placed, frame, view, shape);
    case mjGEOM_CAPSULE:
      return MakeCapsule(placed, frame, view, shape);
    case mjGEOM_CYLINDER:
      return MakeCylinder(placed, frame, view, shape);
    case mjGEOM_BOX:
      return MakeBox(placed, frame, view, shape);
    default:
      CHECK(false) << "geom type " << geom.type;
      return false;
  }
}

}  // namespace shoal::worlds::native
