// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/mass_randomization.h"

#include <mujoco/mujoco.h>

#include "common/base/error.h"

namespace shoal::worlds {
namespace {

// Names of all bodies except the immovable world body 0.
std::string BodyNames(const mjModel& model) {
  std::string names;
  for (int body = 1; body < model.nbody; ++body) {
    const char* name = mj_id2name(&model, mjOBJ_BODY, body);
    if (name != nullptr) names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names;
}

}  // namespace

MassRandomization::MassRandomization(
    const World& world, const std::map<std::string, std::array<double, 2>>& intervals) {
  for (const auto& [name, bounds] : intervals) {
    const int body = mj_name2id(&world.model(), mjOBJ_BODY, name.c_str());
    if (body <= 0) {
      throw UsageError("randomization.body_mass: the model has no body '{}'; bodies: {}", name,
                       BodyNames(world.model()));
    }
    intervals_.push_back({body, bounds[0], bounds[1]});
    drawn_.push_back({name, world.model().body_mass[body]});
  }
}

void MassRandomization::Draw(Random* random, World* world) {
  for (size_t i = 0; i < intervals_.size(); ++i) {
    drawn_[i].mass_kg = random->Uniform(intervals_[i].low, intervals_[i].high);
    world->model().body_mass[intervals_[i].body] = drawn_[i].mass_kg;
  }
}

}  // namespace shoal::worlds
