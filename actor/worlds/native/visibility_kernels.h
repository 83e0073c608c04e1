// SPDX-License-Identifier: Apache-2.0
// Visibility: depth and id of each pixel, shape by shape. Included by the
// sources of the kernels.
//
// A depth is stored as w = 1 / depth. In w, planes and slabs are affine on a
// ray of direction (X, Y, 1), and quadrics are b +- sqrt(d): no shape needs a
// division.
#pragma once

#include "actor/worlds/native/frame_job.h"
#include "actor/worlds/native/lanes.h"

namespace {

using namespace shoal::worlds::native;

// If two surfaces are this close in depth, the later one is seen: geoms that
// share a face would otherwise flicker.
constexpr float kCoincident = 1.00001f;
constexpr float kNever = 3e38f;
// Share of its size by which a triangle is extended beyond its edges.
constexpr float kCrack = 1e-5f;

SHOAL_INLINE F Eval(const Affine& f, F x, F y) { return Set(f.c) + Set(f.x) * x + Set(f.y) * y; }

SHOAL_INLINE F Discriminant(const Quadric& q, F x, F y) {
  return Set(q.d) + x * (Set(q.dx) + Set(q.dxx) * x + Set(q.dxy) * y) +
         y * (Set(q.dy) + Set(q.dyy) * y);
}

// Hits of a shape, one per lane: w and id are valid in the lanes of `hit`.
struct Hit {
  M hit;
  F w;
  I id;
};

SHOAL_INLINE Hit SeeEllipsoid(const Shape& s, F x, F y) {
  const F d = Discriminant(s.quadric, x, y);
  return {d >= Set(0.0f), Eval(s.quadric.b, x, y) + Sqrt(Max(d, Set(0.0f))), Set(s.id)};
}

// Hits the side if the ray enters it between the ends, otherwise the cap.
SHOAL_INLINE Hit SeeCapsule(const Shape& s, F x, F y) {
  const F zero = Set(0.0f);
  const F side_d = Discriminant(s.quadric, x, y);
  const F side = Eval(s.quadric.b, x, y) + Sqrt(Max(side_d, zero));
  const F z = Eval(s.z, x, y);
  M above = z > Set(s.z_high) * side, below = Set(s.z_low) * side > z;
  M seen = side_d >= zero;
  if (s.inside_side) {  // the side is not visible from within
    const M all = zero >= zero, none = zero > zero;
    above = s.cap == 0 ? all : none;
    below = s.cap == 0 ? none : all;
    seen = all;
  }
  F w = side;
  if (Any(above & seen)) {
    const F d = Discriminant(s.caps[0], x, y);
    w = Select(above, Eval(s.caps[0].b, x, y) + Sqrt(Max(d, zero)), w);
    seen = Without(seen, Without(above, d >= zero));
  }
  if (Any(below & seen)) {
    const F d = Discriminant(s.caps[1], x, y);
    w = Select(below, Eval(s.caps[1].b, x, y) + Sqrt(Max(d, zero)), w);
    seen = Without(seen, Without(below, d >= zero));
  }
  return {seen, w, Set(s.id)};
}

// Convex shapes of faces, and cylinders: the ray is inside from the least w of
// `enter` to the greatest of `leave`.
SHOAL_INLINE Hit SeeFaces(const Shape& s, F x, F y) {
  F w = Set(kNever);
  I id = Set(s.id);
  for (int i = 0; i < s.enters; ++i) {
    const F enter = Eval(s.enter[i], x, y);
    id = Select(w > enter, Set(s.id + s.faces[i]), id);
    w = Min(enter, w);
  }
  M hit = w > Set(0.0f);
  if (s.kind == kCylinder) {
    const F d = Discriminant(s.quadric, x, y);
    const F b = Eval(s.quadric.b, x, y), root = Sqrt(Max(d, Set(0.0f)));
    F leave = b + root;
    if (!s.inside_side) {
      const F enter = leave;
      leave = b - root;
      id = Select(w > enter, Set(s.id), id);
      w = Min(enter, w);
      hit = d >= Set(0.0f);
    }
    hit = hit & (w >= leave);
  }
  for (int i = 0; i < s.leaves; ++i) hit = hit & (w >= Eval(s.leave[i], x, y));
  return {hit, w, id};
}

// SeeFaces of the only face that a plane has.
SHOAL_INLINE Hit SeePlane(const Shape& s, F x, F y) {
  const F w = Min(Eval(s.enter[0], x, y), Set(kNever));
  M hit = w > Set(0.0f);
  for (int i = 0; i < s.insides; ++i) hit = hit & (Eval(s.inside[i], x, y) >= Set(0.0f));
  return {hit, w, Set(s.id)};
}

template <ShapeKind kKind>
SHOAL_INLINE Hit SeeOne(const Shape& s, F x, F y) {
  if constexpr (kKind == kEllipsoid) return SeeEllipsoid(s, x, y);
  if constexpr (kKind == kCapsule) return SeeCapsule(s, x, y);
  if constexpr (kKind == kPlane) return SeePlane(s, x, y);
  return SeeFaces(s, x, y);
}

template <ShapeKind kKind, bool kOver>
SHOAL_INLINE void SeeShape(const View& view, const Shape& s, const Tiles& behind,
                           const Tiles& tiles) {
  const F origin_x = Set(s.x), origin_y = Set(s.y);
  const F w_near = Set(view.w_near), w_far = Set(view.w_far);
  for (int row = s.rect.top; row < s.rect.bottom; ++row) {
    for (int column = s.rect.left; column < s.rect.right; ++column) {
      const int64_t tile = (int64_t{row} * view.tiles_x + column) * kTilePixels;
      for (int i = 0; i < kTilePixels; i += kLanes) {
        const F x = Load(view.ray_x + column * kTilePixels + i) - origin_x;
        const F y = Load(view.ray_y + row * kTilePixels + i) - origin_y;
        const Hit at = SeeOne<kKind>(s, x, y);
        const F before = Load(behind.w + tile + i);
        const M seen =
            at.hit & (at.w * Set(kCoincident) >= before) & (at.w >= w_far) & (w_near >= at.w);
        if constexpr (kOver) {
          Store(tiles.w + tile + i, at.w);
          Store(tiles.id + tile + i, Select(seen, at.id, Set(int32_t{kNothing})));
        } else {
          if (!Any(seen)) continue;
          Store(tiles.w + tile + i, Select(seen, at.w, before));
          Store(tiles.id + tile + i, Select(seen, at.id, Load(tiles.id + tile + i)));
        }
      }
    }
  }
}

template <bool kOver>
SHOAL_INLINE void SeeTriangles(const View& view, const Shape& s, const Tiles& behind,
                               const Tiles& tiles) {
  const F w_near = Set(view.w_near), w_far = Set(view.w_far);
  for (int t = 0; t < s.triangles; ++t) {
    const Triangle& triangle = s.triangle[t];
    const F origin_x = Set(triangle.x), origin_y = Set(triangle.y);
    for (int row = triangle.rect.top; row < triangle.rect.bottom; ++row) {
      for (int column = triangle.rect.left; column < triangle.rect.right; ++column) {
        const int64_t tile = (int64_t{row} * view.tiles_x + column) * kTilePixels;
        for (int i = 0; i < kTilePixels; i += kLanes) {
          const F x = Load(view.ray_x + column * kTilePixels + i) - origin_x;
          const F y = Load(view.ray_y + row * kTilePixels + i) - origin_y;
          const F w = Eval(triangle.w, x, y);
          // Neighbours round their common edge differently.
          const F edge = w * Set(-kCrack);
          M seen = (Eval(triangle.edges[0], x, y) >= edge) &
                   (Eval(triangle.edges[1], x, y) >= edge) &
                   (Eval(triangle.edges[2], x, y) >= edge);
          if (!Any(seen)) continue;
          const F before = Load(behind.w + tile + i);
          seen = seen & (w * Set(kCoincident) >= before) & (w >= w_far) & (w_near >= w);
          // Triangles of one transparent mesh hide each other; the engine's do not.
          if constexpr (kOver) {
            const M first = Load(tiles.id + tile + i) == Set(int32_t{kNothing});
            seen = seen & (first | (w >= Load(tiles.w + tile + i)));
          }
          if (!Any(seen)) continue;
          Store(tiles.w + tile + i, Select(seen, w, Load(tiles.w + tile + i)));
          Store(tiles.id + tile + i, Select(seen, Set(s.id), Load(tiles.id + tile + i)));
          Store(tiles.triangle + tile + i,
                Select(seen, Set(int32_t{t}), Load(tiles.triangle + tile + i)));
        }
      }
    }
  }
}

template <bool kOver>
void SeeKind(const View& view, const Shape& s, const Tiles& behind, const Tiles& tiles) {
  switch (s.kind) {
    case kEllipsoid:
      return SeeShape<kEllipsoid, kOver>(view, s, behind, tiles);
    case kCapsule:
      return SeeShape<kCapsule, kOver>(view, s, behind, tiles);
    case kCylinder:
    case kBox:
      return SeeShape<kBox, kOver>(view, s, behind, tiles);
    case kPlane:
      return SeeShape<kPlane, kOver>(view, s, behind, tiles);
    case kTriangles:
      return SeeTriangles<kOver>(view, s, behind, tiles);
  }
}

void See(const View& view, const Shape& s, const Tiles& tiles) {
  SeeKind<false>(view, s, tiles, tiles);
}

void SeeOver(const View& view, const Shape& s, const Tiles& behind, const Tiles& tiles) {
  if (s.kind == kTriangles) {
    for (int row = s.rect.top; row < s.rect.bottom; ++row) {
      const int64_t begin = (int64_t{row} * view.tiles_x + s.rect.left) * kTilePixels;
      const int64_t end = (int64_t{row} * view.tiles_x + s.rect.right) * kTilePixels;
      for (int64_t i = begin; i < end; i += kLanes) {
        Store(tiles.id + i, Set(int32_t{kNothing}));
      }
    }
  }
  SeeKind<true>(view, s, behind, tiles);
}

void Clear(const View& view, const Tiles& tiles) {
  const int64_t pixels = int64_t{view.tiles_x} * view.tiles_y * kTilePixels;
  for (int64_t i = 0; i < pixels; i += kLanes) {
    Store(tiles.w + i, Set(0.0f));
    Store(tiles.id + i, Set(int32_t{kNothing}));
    if (tiles.colour != nullptr) Store(tiles.colour + i, Set(int32_t{0}));
  }
}

void Blend(const TileRect& rect, int tiles_x, float alpha, const Tiles& over, const Tiles& tiles) {
  const F one = Set(alpha), rest = Set(1.0f - alpha), half = Set(0.5f);
  const I byte = Set(int32_t{255});
  for (int row = rect.top; row < rect.bottom; ++row) {
    const int64_t begin = (int64_t{row} * tiles_x + rect.left) * kTilePixels;
    const int64_t end = (int64_t{row} * tiles_x + rect.right) * kTilePixels;
    for (int64_t i = begin; i < end; i += kLanes) {
      const M shown = Load(over.id + i) > Set(int32_t{kNothing});
      if (!Any(shown)) continue;
      const I from = Load(over.colour + i), to = Load(tiles.colour + i);
      const auto mix = [&](I a, I b) {
        return Truncate(one * ToFloat(a) + rest * ToFloat(b) + half);
      };
      const I red = mix(from & byte, to & byte);
      const I green = mix(ShiftRight<8>(from) & byte, ShiftRight<8>(to) & byte);
      const I blue = mix(ShiftRight<16>(from) & byte, ShiftRight<16>(to) & byte);
      const I mixed = red | ShiftLeft<8>(green) | ShiftLeft<16>(blue);
      Store(tiles.colour + i, Select(shown, mixed, to));
    }
  }
}

}  // namespace
