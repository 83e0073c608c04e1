// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/robot_in_picture.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <string_view>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/render_context.h"
#include "actor/worlds/world_registry.h"
#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

std::vector<int> GeomsOf(const mjModel& model, std::string_view prefix) {
  std::vector<int> geoms;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const char* body = mj_id2name(&model, mjOBJ_BODY, model.geom_bodyid[geom]);
    if (body != nullptr && std::string_view(body).starts_with(prefix)) geoms.push_back(geom);
  }
  return geoms;
}

}  // namespace

double ChangedShare(const Picture& a, const Picture& b) {
  CHECK(a.width == b.width && a.height == b.height && a.pixels.size() == b.pixels.size())
      << a.width << " x " << a.height << " and " << b.width << " x " << b.height;
  size_t changed = 0;
  for (size_t i = 0; i < a.pixels.size(); i += 3) {
    changed += !std::equal(&a.pixels[i], &a.pixels[i] + 3, &b.pixels[i]);
  }
  return static_cast<double>(changed) / (static_cast<double>(a.width) * a.height);
}

double RobotShare(World* world, const std::string& prefix, const std::string& camera,
                  const ObservationConfig& observation) {
  mjModel& model = world->model();
  const std::vector<int> geoms = GeomsOf(model, prefix);
  if (geoms.empty()) throw RuntimeError("the model has no body named '{}...'", prefix);
  const CameraView view = FindCamera(*world, camera);
  mj_forward(&model, &world->data());

  ObservationConfig colour = observation;
  colour.grey = false;
  RenderContext render(colour);
  render.Attach(world);
  const auto draw = [&] {
    // The renderer writes planes; they are interleaved below.
    std::vector<uint8_t> planes(static_cast<size_t>(colour.width * colour.height) * 3);
    render.Render(world, {&view, 1}, planes);
    Picture picture{colour.width, colour.height, std::vector<uint8_t>(planes.size())};
    const size_t plane = planes.size() / 3;
    for (size_t i = 0; i < planes.size(); ++i) {
      picture.pixels[i % plane * 3 + i / plane] = planes[i];
    }
    return picture;
  };
  const Picture with = draw();
  std::vector<float> alpha;
  alpha.reserve(geoms.size());
  for (const int geom : geoms) alpha.push_back(std::exchange(model.geom_rgba[4 * geom + 3], 0.0f));
  const Picture without = draw();
  for (size_t i = 0; i < geoms.size(); ++i) model.geom_rgba[4 * geoms[i] + 3] = alpha[i];
  return ChangedShare(with, without);
}

}  // namespace shoal::worlds
