// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/fetch_weld.h"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

// The first numbers of solimp (impedance at both ends of its width) and of solref (time constant in
// s, damping ratio). The width is always 0.001 m.
struct Stiffness {
  double impedance[2], reference[2];
};
constexpr Stiffness kSoftWeld{{0.352478, 0.534707}, {0.0355335, 0.750233}};
constexpr Stiffness kConnect{{0.894243, 0.946952}, {0.0200644, 0.998394}};
constexpr double kWidth = 0.001;

void SetStiffness(mjModel* model, int constraint, const Stiffness& stiffness) {
  double* impedance = model->eq_solimp + mjNIMP * constraint;
  std::copy_n(stiffness.impedance, 2, impedance);
  impedance[2] = kWidth;
  std::copy_n(stiffness.reference, 2, model->eq_solref + mjNREF * constraint);
}

// Index of the first constraint of this type between the two bodies, -1 = none.
int FindConstraint(const mjModel& model, int type, int body, int other) {
  for (int i = 0; i < model.neq; ++i) {
    if (model.eq_type[i] == type && model.eq_obj1id[i] == body && model.eq_obj2id[i] == other) {
      return i;
    }
  }
  return -1;
}

}  // namespace

Physics ParsePhysics(const std::string& name) {
  if (name == "mujoco2") return Physics::kMujoco2;
  if (name == "mujoco3") return Physics::kMujoco3;
  throw UsageError("physics is '{}'; expected mujoco2 or mujoco3", name);
}

std::string WeldAddition(Physics physics) {
  if (physics == Physics::kMujoco2) return "";
  return R"(<equality>
    <connect body1="robot0:mocap" body2="robot0:gripper_link" anchor="0 0 0"/>
  </equality>)";
}

void PrepareWeld(World* world, int mocap_body, int gripper_body, Physics physics) {
  mjModel* const model = &world->model();
  const int weld = FindConstraint(*model, mjEQ_WELD, mocap_body, gripper_body);
  if (weld < 0) {
    throw RuntimeError("{} has no weld of '{}' (body1) and '{}' (body2)", world->source(),
                       mj_id2name(model, mjOBJ_BODY, mocap_body),
                       mj_id2name(model, mjOBJ_BODY, gripper_body));
  }
  // Anchor (3), relative position (3), relative quaternion (4).
  constexpr double kAligned[] = {0, 0, 0, 0, 0, 0, 1, 0, 0, 0};
  std::copy(std::begin(kAligned), std::end(kAligned), model->eq_data + mjNEQDATA * weld);
  if (physics == Physics::kMujoco2) return;

  const int connect = FindConstraint(*model, mjEQ_CONNECT, mocap_body, gripper_body);
  CHECK(connect >= 0) << "a model loaded without the addition";
  std::fill_n(model->eq_data + mjNEQDATA * connect, 6, 0.0);  // both anchors
  SetStiffness(model, weld, kSoftWeld);
  SetStiffness(model, connect, kConnect);
}

}  // namespace shoal::worlds
