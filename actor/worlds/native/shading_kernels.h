// SPDX-License-Identifier: Apache-2.0
// Light and colour of the pixels of one surface. Included by the sources of the
// kernels.
//
// OpenGL's fixed-function light, as the engine sets it up, in each pixel
// instead of each vertex: local viewer, one side, limited to full light before
// the texture.
#pragma once

#include "actor/worlds/native/frame_job.h"
#include "actor/worlds/native/lanes.h"
#include "actor/worlds/native/texture_kernels.h"

namespace {

using namespace shoal::worlds::native;

SHOAL_INLINE F Dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
SHOAL_INLINE Vector Set(const float* v) { return {Set(v[0]), Set(v[1]), Set(v[2])}; }
SHOAL_INLINE Vector Minus(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
SHOAL_INLINE Vector Scale(F s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }

// x^n by squaring.
SHOAL_INLINE F WholePower(F x, int n) {
  F result = Set(1.0f);
  for (; n > 0; n >>= 1) {
    if (n & 1) result = result * x;
    x = x * x;
  }
  return result;
}

// x^e for x in [0, 1], e >= 0, to 1e-4 of the exponent: 2^(e * log2 x), both by
// polynomials.
SHOAL_INLINE F Power(F x, float e) {
  const I bits = Bits(Max(x, Set(1e-30f)));
  const F exponent = ToFloat(ShiftRight<23>(bits) - Set(int32_t{127}));
  const F m = FromBits((bits & Set(int32_t{0x7fffff})) | Set(int32_t{0x3f800000})) - Set(1.0f);
  // log2(1 + m) for m in [0, 1).
  const F log2 =
      exponent +
      m * (Set(1.44254494f) +
           m * (Set(-0.71814525f) +
                m * (Set(0.45754919f) +
                     m * (Set(-0.27735768f) + m * (Set(0.12191179f) + m * Set(-0.02651010f))))));
  const F power = Max(log2 * Set(e), Set(-120.0f));
  const I whole = Floor(power);
  const F r = power - ToFloat(whole);
  const F fraction =
      Set(1.0f) + r * (Set(0.69583282f) + r * (Set(0.22606716f) + r * Set(0.07802453f)));
  return fraction * FromBits(ShiftLeft<23>(whole + Set(int32_t{127})));
}

// The power of a cosine, from its square.
SHOAL_INLINE F Shine(const Surface& s, F squared) {
  const F limited = Min(squared, Set(1.0f));
  return s.whole_exponent >= 0 ? WholePower(limited, s.whole_exponent) : Power(limited, s.exponent);
}

struct Illumination {
  Vector to_light;  // unit
  F strength;       // attenuation times spot
};

SHOAL_INLINE Illumination Illuminate(const Light& light, Vector p) {
  if (light.directional) return {Set(light.direction), Set(1.0f)};
  const Vector to = Minus(Set(light.position), p);
  const F squared = Dot(to, to);
  const F distance = Sqrt(squared);
  const Vector unit = Scale(Set(1.0f) / Max(distance, Set(1e-12f)), to);
  F strength = Set(1.0f) / (Set(light.attenuation[0]) + Set(light.attenuation[1]) * distance +
                            Set(light.attenuation[2]) * squared);
  if (light.cutoff_cosine > -1) {
    const F cosine = Set(0.0f) - Dot(unit, Set(light.direction));
    const F spot = light.exponent == 0
                       ? Set(1.0f)
                       : Power(Min(Max(cosine, Set(0.0f)), Set(1.0f)), light.exponent);
    strength = Select(cosine >= Set(light.cutoff_cosine), strength * spot, Set(0.0f));
  }
  return {unit, strength};
}

// p: points; n: unit normals; to_eye: units, read only if the surface shines.
// kGrey: red stands for all channels.
template <bool kGrey>
SHOAL_INLINE Colour LightAt(const LightSet& lights, const Surface& s, Vector p, Vector n,
                            Vector to_eye) {
  constexpr int kChannels = kGrey ? 1 : 3;
  const F zero = Set(0.0f), one = Set(1.0f);
  F sum[kChannels], limited[kChannels];
  for (int c = 0; c < kChannels; ++c) {
    sum[c] = Set(s.emission[c]);
    limited[c] = zero;
  }
  for (int i = 0; i < lights.count; ++i) {
    const Light& light = lights.light[i];
    const LightColour& colour = s.colours[i];
    if (light.own_pass && !s.merged_passes) {
      for (int c = 0; c < kChannels; ++c) {
        limited[c] = limited[c] + Min(sum[c], one);
        sum[c] = zero;
      }
    }
    const Illumination from = Illuminate(light, p);
    const F facing = Dot(n, from.to_light);
    const M lit = facing > zero;
    const F diffuse = Max(facing, zero);
    F here[kChannels];
    for (int c = 0; c < kChannels; ++c) {
      here[c] = Set(colour.ambient[c]) + Set(colour.diffuse[c]) * diffuse;
    }
    if (s.specular && light.specular && Any(lit)) {
      // The half vector between light and eye, (l + e) / |l + e|.
      const F half = facing + Dot(n, to_eye);
      const F length = Set(2.0f) + Set(2.0f) * Dot(from.to_light, to_eye);
      const F squared = half * half / Max(length, Set(1e-12f));
      const F shine = Select(lit & (half > zero), Shine(s, squared), zero);
      for (int c = 0; c < kChannels; ++c) here[c] = here[c] + Set(colour.specular[c]) * shine;
    }
    for (int c = 0; c < kChannels; ++c) {
      sum[c] = sum[c] + (light.directional ? here[c] : from.strength * here[c]);
    }
  }
  for (int c = 0; c < kChannels; ++c) limited[c] = limited[c] + Min(sum[c], one);
  return {limited[0], limited[kGrey ? 0 : 1], limited[kGrey ? 0 : 2]};
}

SHOAL_INLINE Vector NormalOf(const Surface& s, Vector p) {
  if (s.normal_kind == kFlat) return Set(s.normal);
  const Vector from = Minus(p, Set(s.centre));
  if (s.normal_kind == kRound) return Scale(Set(s.inverse_radius), from);
  if (s.normal_kind == kRod) {
    const Vector axis = Set(s.axis);
    const F limit = Set(s.half_length);
    const F along = Max(Min(Dot(axis, from), limit), Set(0.0f) - limit);
    return Scale(Set(s.inverse_radius), Minus(from, Scale(along, axis)));
  }
  const Vector n{Dot(Set(s.gram), from), Dot(Set(s.gram + 3), from), Dot(Set(s.gram + 6), from)};
  return Scale(Set(1.0f) / Max(Sqrt(Dot(n, n)), Set(1e-20f)), n);
}

SHOAL_INLINE F EvalAxes(const float* axes, Vector p) {
  return Set(axes[0]) * p.x + Set(axes[1]) * p.y + Set(axes[2]) * p.z + Set(axes[3]);
}

// Lights the vertices of one block of a grid.
inline void LightBlock(const LightSet& lights, const Surface& s, int row, int block) {
  PlaneGrid& grid = *s.grid;
  const float y = grid.y[row];
  const float* ey = s.grid_directions[1];
  const Vector normal = Set(s.normal), from = Set(s.centre), along = Set(s.grid_directions[0]);
  for (int i = block * kTilePixels; i < (block + 1) * kTilePixels; i += kLanes) {
    const F x = Load(grid.x + i);
    const Vector p{from.x + along.x * x + Set(ey[0] * y), from.y + along.y * x + Set(ey[1] * y),
                   from.z + along.z * x + Set(ey[2] * y)};
    Vector to_eye = p;
    if (s.specular) to_eye = Scale(Set(-1.0f) / Max(Sqrt(Dot(p, p)), Set(1e-20f)), p);
    const int at = row * grid.stride + i;
    if (s.grey_grid) {
      Store(grid.light[0] + at, LightAt<true>(lights, s, p, normal, to_eye).r);
      continue;
    }
    const Colour colour = LightAt<false>(lights, s, p, normal, to_eye);
    Store(grid.light[0] + at, colour.r);
    Store(grid.light[1] + at, colour.g);
    Store(grid.light[2] + at, colour.b);
  }
}

SHOAL_INLINE void NeedVertex(const LightSet& lights, const Surface& s, int vertex_x, int vertex_y) {
  const int block = vertex_x >> kTilePixelsLog2;
  uint32_t& stamp = s.grid->stamps[vertex_y * (s.grid->stride >> kTilePixelsLog2) + block];
  if (stamp == s.stamp) return;
  stamp = s.stamp;
  LightBlock(lights, s, vertex_y, block);
}

struct GridCell {
  I index;
  F fraction;
};

SHOAL_INLINE GridCell FindCell(const PlaneGrid& grid, int axis, F at) {
  const F zero = Set(0.0f), start = Set(grid.start[axis]), step = Set(grid.step[axis]);
  const F last = Set(static_cast<float>(grid.cells[axis] - 1));
  const F cell = (at - start) * Set(grid.inverse_step[axis]) + Set(1.0f);
  const I index = Truncate(Min(Max(cell, zero), last));
  const F number = ToFloat(index);
  const M first = Set(int32_t{1}) > index;
  const M edge = first | (index == Set(int32_t{grid.cells[axis] - 1}));
  const F left = Select(first, start - Set(grid.pad[axis]), start + (number - Set(1.0f)) * step);
  const F inverse = Select(edge, Set(grid.inverse_pad[axis]), Set(grid.inverse_step[axis]));
  return {index, Min(Max((at - left) * inverse, zero), Set(1.0f))};
}

// Lights the corners of the cells of all lanes in `lanes`. Returns whether that
// is one cell.
SHOAL_INLINE bool NeedCells(const LightSet& lights, const Surface& s, M lanes, I x, I y, I cell) {
  alignas(64) int32_t cells[kLanes], xs[kLanes], ys[kLanes];
  Store(cells, cell);
  Store(xs, x);
  Store(ys, y);
  int found = 0;
  for (M left = lanes; Any(left); ++found) {
    const int lane = FirstLane(left);
    for (int dy = 0; dy < 2; ++dy) {
      NeedVertex(lights, s, xs[lane], ys[lane] + dy);
      NeedVertex(lights, s, xs[lane] + 1, ys[lane] + dy);
    }
    left = Without(left, cell == Set(cells[lane]));
  }
  return found == 1;
}

// Interpolates between the vertices of the grid's triangles: (0, 1, 3) and (1,
// 2, 3) of a cell whose corners are numbered around it.
SHOAL_INLINE Colour GridLight(const LightSet& lights, const Surface& s, M lanes, Vector p) {
  const PlaneGrid& grid = *s.grid;
  const GridCell x = FindCell(grid, 0, EvalAxes(s.grid_axes[0], p));
  const GridCell y = FindCell(grid, 1, EvalAxes(s.grid_axes[1], p));
  const I next = Set(int32_t{1}), stride = Set(int32_t{grid.stride});
  const I origin = Times(y.index, grid.stride) + x.index;
  const bool one_cell = NeedCells(lights, s, lanes, x.index, y.index, origin);
  const F one = Set(1.0f);
  const M low = one >= x.fraction + y.fraction;
  const F u = Select(low, x.fraction, one - x.fraction);
  const F v = Select(low, y.fraction, one - y.fraction);
  const auto mix = [u, v](F a, F b, F c) { return a + u * (b - a) + v * (c - a); };
  Colour colour;
  F* channels[3] = {&colour.r, &colour.g, &colour.b};
  const int count = s.grey_grid ? 1 : 3;
  if (one_cell) {
    alignas(64) int32_t cells[kLanes];
    Store(cells, origin);
    const int at = cells[FirstLane(lanes)];
    for (int c = 0; c < count; ++c) {
      const float* light = grid.light[c] + at;
      const float* upper = light + grid.stride;
      *channels[c] =
          mix(Select(low, Set(light[0]), Set(upper[1])), Select(low, Set(light[1]), Set(upper[0])),
              Select(low, Set(upper[0]), Set(light[1])));
    }
  } else {
    const I a = Select(low, origin, origin + stride + next);
    const I b = Select(low, origin + next, origin + stride);
    const I d = Select(low, origin + stride, origin + next);
    for (int c = 0; c < count; ++c) {
      const float* light = grid.light[c];
      *channels[c] = mix(Gather(light, a), Gather(light, b), Gather(light, d));
    }
  }
  if (count == 1) colour.g = colour.b = colour.r;
  return colour;
}

// How the plane that touches the surface turns away from the ray: normal / (normal . ray).
SHOAL_INLINE void TurnOf(const Surface& s, Vector n, Vector ray, F depth, F* turn_x, F* turn_y) {
  if (s.normal_kind == kFlat) {
    *turn_x = Set(s.turn[0]) * depth;
    *turn_y = Set(s.turn[1]) * depth;
    return;
  }
  const F slant = Dot(n, ray);
  const F away = Select(slant >= Set(0.0f), Max(slant, Set(1e-6f)), Min(slant, Set(-1e-6f)));
  const F inverse = Set(1.0f) / away;
  *turn_x = n.x * inverse;
  *turn_y = n.y * inverse;
}

// ray: (X, Y, 1); p = ray / w. The texture's change from pixel to pixel is that
// on the plane that touches the surface: dp/dX = (e_x - ray * n_x / (n . ray))
// / w.
SHOAL_INLINE Footprint FootprintOf(const View& view, const Surface& s, Vector ray, Vector p,
                                   F turn_x, F turn_y, F depth) {
  const F zero = Set(0.0f);
  const F pixel = depth * Set(view.pixel);
  Footprint f;
  F* at[3] = {&f.at.x, &f.at.y, &f.at.z};
  F* right[3] = {&f.right.x, &f.right.y, &f.right.z};
  F* down[3] = {&f.down.x, &f.down.y, &f.down.z};
  M above = zero > zero, below = above;
  if (s.capsule_caps) {
    const F along = Dot(Set(s.axis), Minus(p, Set(s.centre)));
    above = along > Set(s.half_length);
    below = Set(-s.half_length) > along;
  }
  for (int i = 0; i < (s.mapping == kMapCube ? 3 : 2); ++i) {
    const float* axes = s.texture_axes[i];
    const F along = Set(axes[0]) * ray.x + Set(axes[1]) * ray.y + Set(axes[2]);
    F scale = pixel;
    *at[i] = EvalAxes(axes, p);
    if (i == 2 && s.capsule_caps) {
      const F beyond = Select(above, Set(s.cap_offset), Set(-s.cap_offset));
      const M cap = above | below;
      *at[i] = Select(cap, (*at[i] - beyond) * Set(s.cap_scale), *at[i]);
      scale = Select(cap, scale * Set(s.cap_scale), scale);
    }
    *right[i] = scale * (Set(axes[0]) - along * turn_x);
    *down[i] = scale * (Set(axes[1]) - along * turn_y);
  }
  return f;
}

struct MeshPoint {
  Vector normal;
  F turn_x, turn_y;  // the triangle's plane's change of depth
  Footprint coords;  // of the texture, where the mesh has its own
};

// Interpolates between the corners of each lane's triangle.
SHOAL_INLINE MeshPoint MeshAt(const View& view, const Surface& s, M lanes, I numbers, F ray_x,
                              F ray_y, F depth) {
  alignas(64) int32_t stored[kLanes];
  Store(stored, numbers);
  const F zero = Set(0.0f);
  MeshPoint point{{zero, zero, zero}, zero, zero, {}};
  Vector object{zero, zero, zero};
  F coords[6] = {zero, zero, zero, zero, zero, zero};
  for (M left = lanes; Any(left);) {
    const int number = stored[FirstLane(left)];
    const M here = left & (numbers == Set(int32_t{number}));
    left = Without(left, here);
    const Triangle& triangle = s.mesh.triangles[number];
    const float* n = s.mesh.normals + 9 * int64_t{triangle.index};
    const F x = ray_x - Set(triangle.x), y = ray_y - Set(triangle.y);
    F b[3];
    for (int k = 0; k < 3; ++k) {
      const Affine& edge = triangle.edges[k];
      b[k] = (Set(edge.c) + Set(edge.x) * x + Set(edge.y) * y) * depth;
    }
    const auto mix = [&b](const float* corner, int stride) {
      return b[0] * Set(corner[0]) + b[1] * Set(corner[stride]) + b[2] * Set(corner[2 * stride]);
    };
    object.x = Select(here, mix(n, 3), object.x);
    object.y = Select(here, mix(n + 1, 3), object.y);
    object.z = Select(here, mix(n + 2, 3), object.z);
    point.turn_x = Select(here, Set(triangle.w.x) * depth, point.turn_x);
    point.turn_y = Select(here, Set(triangle.w.y) * depth, point.turn_y);
    if (s.mesh.coords == nullptr) continue;
    const float* c = s.mesh.coords + 6 * int64_t{triangle.index};
    for (int k = 0; k < 2; ++k) {
      const F at = mix(c + k, 2);
      float along_x = 0, along_y = 0;
      for (int corner = 0; corner < 3; ++corner) {
        along_x += triangle.edges[corner].x * c[2 * corner + k];
        along_y += triangle.edges[corner].y * c[2 * corner + k];
      }
      coords[k] = Select(here, at, coords[k]);
      const F pixel = depth * Set(view.pixel);
      coords[2 + k] = Select(here, (Set(along_x) - at * Set(triangle.w.x)) * pixel, coords[2 + k]);
      coords[4 + k] = Select(here, (Set(along_y) - at * Set(triangle.w.y)) * pixel, coords[4 + k]);
    }
  }
  const float(*axes)[3] = s.mesh.axes;
  F* to[3] = {&point.normal.x, &point.normal.y, &point.normal.z};
  for (int k = 0; k < 3; ++k) {
    *to[k] = Set(axes[0][k]) * object.x + Set(axes[1][k]) * object.y + Set(axes[2][k]) * object.z;
  }
  const F length = Max(Sqrt(Dot(point.normal, point.normal)), Set(1e-20f));
  point.normal = Scale(Set(1.0f) / length, point.normal);
  point.coords = {
      {coords[0], coords[1], zero}, {coords[2], coords[3], zero}, {coords[4], coords[5], zero}};
  return point;
}

SHOAL_INLINE I Pack(Colour c) {
  const F one = Set(1.0f), full = Set(255.0f), half = Set(0.5f);
  const I r = Truncate(Min(c.r, one) * full + half);
  const I g = Truncate(Min(c.g, one) * full + half);
  const I b = Truncate(Min(c.b, one) * full + half);
  return r | ShiftLeft<8>(g) | ShiftLeft<16>(b);
}

struct Group {
  M mine;  // lanes of the surface; others hold anything
  F x, y, w, inverse_length;
  I triangle;
};

template <bool kMesh>
SHOAL_INLINE I ShadeGroup(const View& view, const LightSet& lights, const Surface& s,
                          const Group& g) {
  const F depth = Set(1.0f) / Select(g.mine, g.w, Set(1.0f));
  const Vector ray{g.x, g.y, Set(1.0f)};
  const Vector p = Scale(depth, ray);
  [[maybe_unused]] MeshPoint mesh;
  Vector n;
  if constexpr (kMesh) {
    mesh = MeshAt(view, s, g.mine, g.triangle, g.x, g.y, depth);
    n = mesh.normal;
  } else {
    n = NormalOf(s, p);
  }
  Colour colour{Set(s.light[0]), Set(s.light[1]), Set(s.light[2])};
  if (!s.one_light) {
    colour = s.grid != nullptr
                 ? GridLight(lights, s, g.mine, p)
                 : LightAt<false>(lights, s, p, n, Scale(Set(0.0f) - g.inverse_length, ray));
  }
  if (s.mapping != kNoTexture) {
    Footprint f;
    if constexpr (kMesh) {
      f = s.mesh.coords != nullptr ? mesh.coords
                                   : FootprintOf(view, s, ray, p, mesh.turn_x, mesh.turn_y, depth);
    } else {
      F turn_x, turn_y;
      TurnOf(s, n, ray, depth, &turn_x, &turn_y);
      f = FootprintOf(view, s, ray, p, turn_x, turn_y, depth);
    }
    const Colour texel =
        s.mapping == kMap2d ? LookUp2d(*s.texture, g.mine, f) : LookUpCube(*s.texture, g.mine, f);
    colour = {colour.r * texel.r, colour.g * texel.g, colour.b * texel.b};
  }
  return Pack(colour);
}

template <bool kMesh>
SHOAL_INLINE void ShadeRect(const View& view, const LightSet& lights, const Surface& s,
                            const Tiles& tiles) {
  const bool uniform = s.one_light && s.mapping == kNoTexture;
  const I colour = Pack({Set(s.light[0]), Set(s.light[1]), Set(s.light[2])});
  for (int row = s.rect.top; row < s.rect.bottom; ++row) {
    for (int column = s.rect.left; column < s.rect.right; ++column) {
      const int64_t tile = (int64_t{row} * view.tiles_x + column) * kTilePixels;
      for (int i = 0; i < kTilePixels; i += kLanes) {
        const M mine = Load(tiles.id + tile + i) == Set(int32_t{s.id});
        if (!Any(mine)) continue;
        I shaded = colour;
        if (!uniform) {
          Group group{mine,
                      Load(view.ray_x + column * kTilePixels + i),
                      Load(view.ray_y + row * kTilePixels + i),
                      Load(tiles.w + tile + i),
                      Load(view.inverse_length + tile + i),
                      Set(int32_t{0})};
          if constexpr (kMesh) group.triangle = Load(tiles.triangle + tile + i);
          shaded = ShadeGroup<kMesh>(view, lights, s, group);
        }
        Store(tiles.colour + tile + i, Select(mine, shaded, Load(tiles.colour + tile + i)));
      }
    }
  }
}

void Shade(const View& view, const LightSet& lights, const Surface& s, const Tiles& tiles) {
  if (s.normal_kind == kMeshNormals) {
    ShadeRect<true>(view, lights, s, tiles);
  } else {
    ShadeRect<false>(view, lights, s, tiles);
  }
}

// The sky is a cube around the eye; its texture is not lit.
void Sky(const View& view, const Tiles& tiles) {
  const float(*axes)[3] = view.sky_axes;
  const F pixel = Set(view.pixel);
  for (int row = 0; row < view.tiles_y; ++row) {
    for (int column = 0; column < view.tiles_x; ++column) {
      const int64_t tile = (int64_t{row} * view.tiles_x + column) * kTilePixels;
      for (int i = 0; i < kTilePixels; i += kLanes) {
        const M bare = Load(tiles.id + tile + i) == Set(int32_t{kNothing});
        if (!Any(bare)) continue;
        const F x = Load(view.ray_x + column * kTilePixels + i);
        const F y = Load(view.ray_y + row * kTilePixels + i);
        const auto at = [&](int k) {
          return Set(axes[k][0]) * x + Set(axes[k][1]) * y + Set(axes[k][2]);
        };
        const auto right = [&](int k) { return Set(axes[k][0]) * pixel; };
        const auto down = [&](int k) { return Set(axes[k][1]) * pixel; };
        const Footprint f{
            {at(0), at(1), at(2)}, {right(0), right(1), right(2)}, {down(0), down(1), down(2)}};
        const I colour = Pack(LookUpCube(*view.sky, bare, f));
        Store(tiles.colour + tile + i, Select(bare, colour, Load(tiles.colour + tile + i)));
      }
    }
  }
}

}  // namespace
