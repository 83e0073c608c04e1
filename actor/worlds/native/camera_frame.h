// SPDX-License-Identifier: Apache-2.0
// The camera that the engine uses for a scene, and the rays of its pixels.
//
// All code of this folder computes with + - * / and square roots only, without contraction, so that
// frames are equal on all CPUs.
#pragma once

#include <array>
#include <vector>

#include "actor/worlds/native/frame_job.h"

struct mjvScene_;

namespace shoal::worlds::native {

struct Vector3 {
  double x = 0, y = 0, z = 0;
};

inline Vector3 operator+(Vector3 a, Vector3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector3 operator-(Vector3 a, Vector3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector3 operator*(double s, Vector3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline double Dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector3 Cross(Vector3 a, Vector3 b);
double Length(Vector3 a);
Vector3 Normalized(Vector3 a);  // zero stays zero
inline Vector3 FromFloats(const float* v) { return {v[0], v[1], v[2]}; }
// Column `i` of a row-major 3x3 matrix: an axis of a geom.
inline Vector3 ColumnOf(const float* mat, int i) { return {mat[i], mat[3 + i], mat[6 + i]}; }

// Camera coordinates: x right, y up, z ahead.
struct CameraFrame {
  Vector3 position, right, up, forward;
  double half_width = 0, half_height = 0;  // of the view at distance 1
  double centre_y = 0;                     // of the view at distance 1
  double near = 0, far = 0;

  Vector3 Direction(Vector3 v) const { return {Dot(right, v), Dot(up, v), Dot(forward, v)}; }
  Vector3 Point(Vector3 p) const { return Direction(p - position); }
};

// The mean of the scene's two cameras. Throws Error if the camera is not finite or its near plane
// is not in front of the eye.
CameraFrame FrameOf(const mjvScene_& scene, int width, int height);

// The rays of a picture, tile after tile. Owns the arrays that View points to.
class RayTables {
 public:
  // Fills `view` except the sky.
  void Fill(const CameraFrame& frame, int width, int height, View* view);

 private:
  std::array<double, 3> kept_{};  // half width, half height and centre of the present tables
  int width_ = 0, height_ = 0;
  std::vector<float> x_, y_, inverse_length_;
};

}  // namespace shoal::worlds::native
