// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/control_world.h"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "actor/worlds/model_cameras.h"
#include "actor/worlds/model_loading.h"
#include "actor/worlds/model_sizes.h"
#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds {

ControlWorld::ControlWorld(const std::string& model_name, const std::string& model_file,
                           const Shape& shape)
    : World(LoadModel(model_name, model_file), model_file),
      engine_steps_(shape.engine_steps),
      cameras_(ModelCameras(model())) {
  CheckModelSizes(model(), shape.joints, shape.actuators);
}

void ControlWorld::Reset(Random* random) {
  Begin();
  Draw(random);
  Finish();
}

void ControlWorld::ResetTo(std::span<const double> qpos, std::span<const double> qvel) {
  CHECK(qpos.size() == size_t(model().nq) && qvel.size() == size_t(model().nv))
      << qpos.size() << ' ' << qvel.size();
  Begin();
  std::copy(qpos.begin(), qpos.end(), data().qpos);
  std::copy(qvel.begin(), qvel.end(), data().qvel);
  Finish();
}

void ControlWorld::Begin() {
  mj_resetData(&model(), &data());
  ForwardWithoutActuation();
}

void ControlWorld::Finish() {
  Settle();
  ForwardWithoutActuation();
}

World::Outcome ControlWorld::Step(std::span<const double> action) {
  CHECK(action.size() == size_t(model().nu)) << action.size();
  std::copy(action.begin(), action.end(), data().ctrl);
  AdvanceControl(engine_steps_);
  return {.reward = Reward()};
}

void ControlWorld::AdvanceControl(int engine_steps) {
  if (model().opt.integrator == mjINT_RK4) {
    Advance(engine_steps);
  } else {
    // The preceding control step has already done the first half of this engine step (mj_step1).
    mj_step2(&model(), &data());
    Advance(engine_steps - 1);
  }
  mj_step1(&model(), &data());
  CheckState();
}

void ControlWorld::ForwardWithoutActuation() {
  const int flags = model().opt.disableflags;
  model().opt.disableflags |= mjDSBL_ACTUATION;
  mj_forward(&model(), &data());
  model().opt.disableflags = flags;
}

bool ControlWorld::NothingTouches() const { return data().ncon == 0; }

void ControlWorld::GiveUpDrawing() const {
  throw RuntimeError("no initial state without contact in {} attempts", kMostDraws);
}

}  // namespace shoal::worlds
