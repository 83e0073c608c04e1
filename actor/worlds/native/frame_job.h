// SPDX-License-Identifier: Apache-2.0
// Plain data between the setup of a frame and the kernels that draw it.
//
// Coordinates are the camera's: x right, y up, z ahead, the eye at the origin.
// The ray of a pixel is (X, Y, 1), so a point on it is (X, Y, 1) / w with w = 1
// / depth. Tiles are 4x4 pixels; the pixels of a tile are stored so that 4
// neighbours (2x2), 8 (4x2) and 16 (4x4) are contiguous: column = (i & 1) + 2 *
// (i >> 2 & 1), row = (i >> 1 & 1) + 2 * (i >> 3).
//
// The kernels include this header with wider instruction sets than the rest of
// the program. This header must therefore contain no functions and include no header with
// functions.
#pragma once

#include <cstdint>

namespace shoal::worlds::native {

constexpr int kTileSide = 4, kTilePixels = 16, kTilePixelsLog2 = 4;
constexpr int kMostLevels = 16, kMostLights = 100;
constexpr int kNothing = -1;  // id of a pixel that shows the sky

// c + x * X + y * Y, with X and Y relative to the shape's origin.
struct Affine {
  float c, x, y;
};

// Roots in w of a quadric on a ray: b +- sqrt(d), d a quadratic form of X and
// Y.
struct Quadric {
  Affine b;
  float d, dx, dy, dxx, dxy, dyy;
};

struct TileRect {
  int left, top, right, bottom;  // in tiles, right and bottom excluded
};

enum ShapeKind : int32_t { kEllipsoid, kCapsule, kCylinder, kBox, kPlane, kTriangles };

struct Triangle {
  int index;  // in its mesh
  TileRect rect;
  float x, y;       // origin
  Affine w;         // 1 / depth
  Affine edges[3];  // barycentric coordinates times w
};

// Data of a geom for the visibility pass. The pixels of the geom get id + face.
struct Shape {
  ShapeKind kind;
  int id;
  TileRect rect;
  float x, y;           // origin of the affine functions
  Quadric quadric;      // ellipsoid, or the side of a capsule or cylinder
  Quadric caps[2];      // of a capsule: at +z and at -z
  bool inside_side;     // the eye is within the endless cylinder
  int cap;              // if inside_side: cap that the eye looks at, 0 = +z
  Affine z;             // z axis times ray
  float z_low, z_high;  // axis coordinate of the ends, relative to the eye
  // Faces of boxes, cylinders and planes: w is the least of `enter` and must
  // not be below any of `leave`. Planes are only hit where, in addition, every
  // `inside` is at least zero.
  int enters, leaves, insides;
  int faces[3];
  Affine enter[3], leave[6], inside[4];
  int triangles;
  const Triangle* triangle;
};

// Light in the camera's coordinates. The surfaces' LightColour has its colours.
struct Light {
  bool directional;
  float direction[3];  // towards a directional light; axis of a spot
  float position[3];
  float attenuation[3];
  float cutoff_cosine;  // -1 or less: shines everywhere
  float exponent;
  bool specular;  // any channel
  bool own_pass;  // added after the sum of the other lights was limited to full light
};

struct LightColour {
  float ambient[3], diffuse[3], specular[3];  // material included
};

enum NormalKind : int32_t { kFlat, kRound, kRod, kOval, kMeshNormals };

// A texel, r | g << 8 | b << 16, and the one below it. Two neighbours in a row are the four texels
// between which a look-up interpolates: one load of 16 bytes.
struct TexelPair {
  int32_t upper, lower;
};

// A texture in memory. A level has the faces of a cube (+x, -x, +y, -y, +z, -z)
// one after another, rows from t = 0. Each face has a border of one texel,
// so it has (height + 2, width + 2) texels in (height + 1, width + 2) pairs. The
// border repeats the edge of a cube's face, and the opposite edge of another
// texture.
struct Texture {
  int levels;
  bool cube;
  const TexelPair* level[kMostLevels];
  int width[kMostLevels], height[kMostLevels];
};

enum TextureMapping : int32_t { kNoTexture, kMap2d, kMapCube };

// Light at a vertex of a grid and at the next one along the plane's y.
struct LightPair {
  float upper, lower;
};

// Grid of a plane; light is computed at its vertices. Axes k = 0, 1 are the plane's x and y.
struct PlaneGrid {
  int cells[2];
  float start[2], step[2], inverse_step[2];  // of the second cell
  float pad[2], inverse_pad[2];              // width of the first and last cell
  int stride;                                // vertices in a row, a multiple of kTilePixels
  const float* x;                            // (stride) positions of vertices
  const float* y;                            // (cells[1] + 1)
  LightPair* light[3];                       // (cells[1] + 1, stride); written on demand
  uint32_t* stamps;  // (cells[1] + 1, stride / kTilePixels): frame that lit the block
};

struct MeshData {
  const Triangle* triangles;  // the shape's
  const float* normals;       // (T, 3, 3), in the geom's coordinates, by Triangle::index
  const float* coords;        // (T, 3, 2) texture coordinates; null = none
  float axes[3][3];           // the geom's axes
};

// One colour rule for the pixels with this id.
struct Surface {
  int id;
  TileRect rect;
  NormalKind normal_kind;
  float normal[3];
  float centre[3], axis[3], inverse_radius, half_length;
  float gram[9];  // kOval: normal = gram * (p - centre)
  float turn[2];  // kFlat: normal x and y / distance of the plane from the eye
  float emission[3];
  bool one_light;       // light is the same everywhere: `light`
  bool one_dull_light;  // a plane's light is the same wherever it does not shine
  float light[3];
  LightColour* colours;  // (lights)
  bool specular;
  bool merged_passes;  // transparent: one sum of all lights
  float exponent;      // of the cosine's square
  int whole_exponent;  // -1 = not a whole number
  float least_shine;   // squares of cosines below it have no visible power
  PlaneGrid* grid;     // null = lit per pixel
  bool grey_grid;
  float grid_axes[2][4];        // plane coordinates = axes * (p, 1)
  float grid_directions[2][3];  // a unit along the plane's x and y; its origin
                                // is `centre`
  uint32_t stamp;
  TextureMapping mapping;
  const Texture* texture;
  float texture_axes[3][4];  // texture coordinates = axes * (p, 1)
  // Cube coordinate z of a capsule's caps: scale * (z -+ offset) beyond the
  // half length.
  bool capsule_caps;
  float cap_scale, cap_offset;
  MeshData mesh;
};

struct View {
  int width, height, tiles_x, tiles_y;
  const float* ray_x;           // (tiles_x, 16)
  const float* ray_y;           // (tiles_y, 16)
  const float* inverse_length;  // (tiles, 16): 1 / |(X, Y, 1)|
  float pixel;                  // distance of neighbouring rays
  float w_near, w_far;
  const Texture* sky;    // null = black
  float sky_axes[3][3];  // cube coordinates = axes * (X, Y, 1)
};

// The engine paints the sky on a cylinder about the eye, which hides what is farther away. Around
// the foot of the sky it draws a band of haze over an endless plane: a cone about the eye that
// rises from the plane to the height of the eye. Lengths are in radii of the cylinder.
struct Haze {
  float inverse_sky;  // 1 / the cylinder's radius, in m
  bool seen;          // the other members are read only if true
  float axes[3][3];   // the plane's x, y and normal: coordinate = axis * (X, Y, 1)
  float elevation;    // of the eye above the plane
  float width;        // difference between the radii of the cylinder and of the cone at the plane
  float peak;         // share of the way from the eye's height to the plane at which haze hides all
  float rgb[3];       // 0..255
};

// Arrays with one value per pixel, tile after tile.
struct Tiles {
  float* w;
  int32_t* id;
  int32_t* colour;    // r | g << 8 | b << 16
  int32_t* triangle;  // number in Shape::triangle, if the id belongs to a mesh
};

struct LightSet {
  int count;
  const Light* light;
};

// The kernels of one instruction set. Functions of a shape or surface touch the
// tiles of its rect.
struct Kernels {
  const char* name;
  int lanes;
  // Removes depth and id of all pixels, and the colour unless it is null.
  void (*clear)(const View&, const Tiles&);
  // Writes depth and id of the pixels where the shape is nearer than the stored depth.
  void (*see)(const View&, const Shape&, const Tiles&);
  // Like see, but compares with the depth of `behind`, which does not change. Pixels of `tiles`
  // that do not show the shape lose their id.
  void (*see_over)(const View&, const Shape&, const Tiles& behind, const Tiles& tiles);
  // Colours the pixels with the surface's id.
  void (*shade)(const View&, const LightSet&, const Surface&, const Tiles&);
  // colour = alpha * over + (1 - alpha) * colour where `over` has an id.
  void (*blend)(const TileRect&, int tiles_x, float alpha, const Tiles& over, const Tiles&);
  // Colours the pixels without id. Needs view.sky.
  void (*sky)(const View&, const Tiles&);
  // Writes colour and depth of the sky to the pixels beyond the sky's cylinder, then blends the
  // haze. Needs view.sky.
  void (*haze)(const View&, const Haze&, const Tiles&);
  // Writes colours to planes (3, H, W) of bytes, row 0 = top.
  void (*write)(const View&, const int32_t* colours, uint8_t* planes);
};

extern const Kernels kSse2Kernels, kAvx2Kernels, kAvx512Kernels;

}  // namespace shoal::worlds::native
