// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/screen_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shoal::worlds::native {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

// A plane through the eye consists of all points with x = k z. Such planes touch an ellipsoid at
// the roots k of a k^2 - 2 b k + c. False: there is no bound, because the ellipsoid reaches behind
// the eye.
bool Tangents(double a, double b, double c, double* low, double* high) {
  const double squared = b * b - a * c;
  if (a <= 0 || squared < 0) return false;
  const double root = std::sqrt(squared);
  *low = (b - root) / a;
  *high = (b + root) / a;
  return true;
}

}  // namespace

RayRect EmptyRect() { return {kEndless, -kEndless, kEndless, -kEndless}; }

RayRect Union(const RayRect& a, const RayRect& b) {
  return {std::min(a.left, b.left), std::max(a.right, b.right), std::min(a.bottom, b.bottom),
          std::max(a.top, b.top)};
}

RayRect BoundEllipsoid(Vector3 centre, const std::array<Vector3, 3>& axes,
                       const std::array<double, 3>& radii, double near) {
  double xx = 0, yy = 0, zz = 0, xz = 0, yz = 0;
  for (size_t i = 0; i < 3; ++i) {
    const double squared = radii[i] * radii[i];
    const Vector3& axis = axes[i];
    xx += squared * axis.x * axis.x;
    yy += squared * axis.y * axis.y;
    zz += squared * axis.z * axis.z;
    xz += squared * axis.x * axis.z;
    yz += squared * axis.y * axis.z;
  }
  if (centre.z + std::sqrt(zz) < near) return EmptyRect();
  RayRect rect{-kEndless, kEndless, -kEndless, kEndless};
  if (centre.z <= 0) return rect;
  const double a = centre.z * centre.z - zz;
  Tangents(a, centre.x * centre.z - xz, centre.x * centre.x - xx, &rect.left, &rect.right);
  Tangents(a, centre.y * centre.z - yz, centre.y * centre.y - yy, &rect.bottom, &rect.top);
  return rect;
}

RayRect BoundHull(std::span<const Vector3> points, std::span<const std::array<int, 2>> edges,
                  double near) {
  RayRect rect = EmptyRect();
  const auto add = [&rect](double x, double y, double z) {
    rect = Union(rect, {x / z, x / z, y / z, y / z});
  };
  for (const Vector3& p : points) {
    if (p.z >= near) add(p.x, p.y, p.z);
  }
  for (const auto& [first, second] : edges) {
    const Vector3& a = points[static_cast<size_t>(first)];
    const Vector3& b = points[static_cast<size_t>(second)];
    if ((a.z >= near) == (b.z >= near)) continue;
    const double share = (near - a.z) / (b.z - a.z);
    add(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), near);
  }
  return rect;
}

bool TilesOf(const RayRect& rect, const CameraFrame& frame, const View& view, TileRect* tiles) {
  constexpr double kMargin = 0.01;  // pixels: kernels round to float
  if (!(rect.left <= rect.right && rect.bottom <= rect.top)) return false;
  const auto clamp = [](double pixel, int most) {
    return static_cast<int>(std::clamp(pixel, -1.0, static_cast<double>(most)));
  };
  const double columns = 0.5 * view.width / frame.half_width;
  const double rows = 0.5 * view.height / frame.half_height;
  const double top = frame.half_height + frame.centre_y;
  // Pixel i is covered if its centre, i + 1/2, is covered.
  const int left =
      clamp(std::ceil((rect.left + frame.half_width) * columns - 0.5 - kMargin), view.width);
  const int right =
      clamp(std::floor((rect.right + frame.half_width) * columns - 0.5 + kMargin), view.width);
  const int upper = clamp(std::ceil((top - rect.top) * rows - 0.5 - kMargin), view.height);
  const int lower = clamp(std::floor((top - rect.bottom) * rows - 0.5 + kMargin), view.height);
  const int first_column = std::max(left, 0), last_column = std::min(right, view.width - 1);
  const int first_row = std::max(upper, 0), last_row = std::min(lower, view.height - 1);
  if (first_column > last_column || first_row > last_row) return false;
  *tiles = {first_column / kTileSide, first_row / kTileSide, last_column / kTileSide + 1,
            last_row / kTileSide + 1};
  return true;
}

}  // namespace shoal::worlds::native
