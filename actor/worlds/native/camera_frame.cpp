// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/camera_frame.h"

#include <mujoco/mujoco.h>

#include <cmath>

#include "common/base/error.h"

namespace shoal::worlds::native {

Vector3 Cross(Vector3 a, Vector3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double Length(Vector3 a) { return std::sqrt(Dot(a, a)); }

Vector3 Normalized(Vector3 a) {
  const double length = Length(a);
  return length > 0 ? (1 / length) * a : a;
}

CameraFrame FrameOf(const mjvScene& scene, int width, int height) {
  const mjvGLCamera &a = scene.camera[0], &b = scene.camera[1];
  CameraFrame frame;
  frame.position = 0.5 * (FromFloats(a.pos) + FromFloats(b.pos));
  frame.forward = Normalized(0.5 * (FromFloats(a.forward) + FromFloats(b.forward)));
  frame.right = Normalized(Cross(frame.forward, 0.5 * (FromFloats(a.up) + FromFloats(b.up))));
  frame.up = Cross(frame.right, frame.forward);
  const double near = 0.5 * (double{a.frustum_near} + b.frustum_near);
  const double top = 0.5 * (double{a.frustum_top} + b.frustum_top);
  const double bottom = 0.5 * (double{a.frustum_bottom} + b.frustum_bottom);
  frame.near = near;
  frame.far = 0.5 * (double{a.frustum_far} + b.frustum_far);
  frame.half_height = 0.5 * (top - bottom) / near;
  frame.half_width = frame.half_height * width / height;
  frame.centre_y = 0.5 * (top + bottom) / near;
  const double sum = Dot(frame.position, frame.position) + Dot(frame.forward, frame.right) +
                     Dot(frame.up, frame.up) + frame.far + frame.half_height + frame.centre_y;
  if (!std::isfinite(sum) || near <= 0 || frame.half_height <= 0 || Length(frame.up) == 0) {
    throw NonFiniteError(
        "the camera cannot be drawn with: position ({}, {}, "
        "{}), near plane {}, half height {}; "
        "expected finite numbers and a near plane above 0",
        frame.position.x, frame.position.y, frame.position.z, near, frame.half_height);
  }
  return frame;
}

void RayTables::Fill(const CameraFrame& frame, int width, int height, View* view) {
  view->width = width;
  view->height = height;
  view->tiles_x = (width + kTileSide - 1) / kTileSide;
  view->tiles_y = (height + kTileSide - 1) / kTileSide;
  view->pixel = static_cast<float>(2 * frame.half_height / height);
  view->w_near = static_cast<float>(1 / frame.near);
  view->w_far = static_cast<float>(1 / frame.far);
  const std::array<double, 3> wanted{frame.half_width, frame.half_height, frame.centre_y};
  if (kept_ != wanted || width_ != width || height_ != height) {
    kept_ = wanted;
    width_ = width;
    height_ = height;
    x_.resize(static_cast<size_t>(view->tiles_x) * kTilePixels);
    y_.resize(static_cast<size_t>(view->tiles_y) * kTilePixels);
    for (size_t i = 0; i < x_.size(); ++i) {
      const size_t column = i / kTilePixels * kTileSide + (i & 1) + 2 * (i >> 2 & 1);
      const double share = (static_cast<double>(column) + 0.5) / width;
      x_[i] = static_cast<float>(frame.half_width * (2 * share - 1));
    }
    for (size_t i = 0; i < y_.size(); ++i) {
      const size_t row = i / kTilePixels * kTileSide + (i >> 1 & 1) + 2 * (i >> 3 & 1);
      const double share = (static_cast<double>(row) + 0.5) / height;
      y_[i] = static_cast<float>(frame.centre_y + frame.half_height * (1 - 2 * share));
    }
    inverse_length_.clear();
    for (size_t row = 0; row < y_.size(); row += kTilePixels) {
      for (size_t column = 0; column < x_.size(); column += kTilePixels) {
        for (size_t i = 0; i < kTilePixels; ++i) {
          const double x = x_[column + i], y = y_[row + i];
          inverse_length_.push_back(static_cast<float>(1 / std::sqrt(x * x + y * y + 1)));
        }
      }
    }
  }
  view->ray_x = x_.data();
  view->ray_y = y_.data();
  view->inverse_length = inverse_length_.data();
}

}  // namespace shoal::worlds::native
