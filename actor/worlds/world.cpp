// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/world.h"

#include <mujoco/mujoco.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "actor/worlds/episode_fault.h"
#include "actor/worlds/model_loading.h"
#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds {

namespace {

ModelHandle Checked(ModelHandle model) {
  if (model == nullptr) throw UsageError("World: the physics half gave no model");
  return model;
}

}  // namespace

World::World(ModelHandle model, const std::string& model_file)
    : model_(Checked(std::move(model))),
      source_(model_file.empty() ? "the model" : fmt::format("model file '{}'", model_file)),
      data_(MakeData(*model_)),
      fingerprint_(ModelFingerprint(*model_)) {}

void World::ReleaseTextures() {
  textures_released_ = true;
  // The whole model is one allocation, so only whole pages inside the textures can be released.
  const auto page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
  const auto size = static_cast<size_t>(model_->ntexdata);
  const size_t before = (page - reinterpret_cast<uintptr_t>(model_->tex_rgb) % page) % page;
  if (size < before + page) return;
  const size_t whole_pages = (size - before) / page * page;
  CHECK(madvise(model_->tex_rgb + before, whole_pages, MADV_DONTNEED) == 0)
      << "giving back " << whole_pages << " bytes of textures";
}

int World::ElementId(int object_type, const char* kind, const std::string& name) const {
  const int id = mj_name2id(model_.get(), object_type, name.c_str());
  if (id < 0) throw RuntimeError("{} has no {} named '{}'", source_, kind, name);
  return id;
}

int World::BodyId(const std::string& name) const { return ElementId(mjOBJ_BODY, "body", name); }
int World::SiteId(const std::string& name) const { return ElementId(mjOBJ_SITE, "site", name); }
int World::JointId(const std::string& name) const { return ElementId(mjOBJ_JOINT, "joint", name); }
int World::GeomId(const std::string& name) const { return ElementId(mjOBJ_GEOM, "geom", name); }
int World::SensorId(const std::string& name) const {
  return ElementId(mjOBJ_SENSOR, "sensor", name);
}

void World::PlaceSite(int site, std::span<const double> position) {
  if (position.size() != 3 || site < 0 || site >= model_->nsite) {
    throw UsageError("PlaceSite: site {} of {} at {} numbers; expected a site of {} and 3 numbers",
                     site, model_->nsite, position.size(), source_);
  }
  std::copy(position.begin(), position.end(), model_->site_pos + 3 * site);
  model_->site_sameframe[site] =
      0;  // 1 would mean the body's frame, as decided when the model was compiled
}

void World::LookAtGoal(const std::function<void()>& look) {
  CHECK(CanMoveToGoal());
  if (kept_data_ == nullptr) kept_data_ = MakeData(*model_);
  mj_copyData(kept_data_.get(), model_.get(), data_.get());
  MoveToGoal();
  look();
  mj_copyData(data_.get(), model_.get(), kept_data_.get());
}

double World::simulated_seconds() const { return data_->time; }

void World::SetControls(std::span<const double> action) {
  if (action.size() != static_cast<size_t>(model_->nu)) {
    throw UsageError(
        "SetControls: the task's action has {} numbers, {} has {} actuators; expected one each",
        action.size(), source_, model_->nu);
  }
  std::ranges::copy(action, data_->ctrl);
}

void World::ForgetDivergence() {
  for (const int kind : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC}) {
    data_->warning[kind].number = 0;
  }
}

void World::Advance(int count) {
  for (int i = 0; i < count; ++i) mj_step(model_.get(), data_.get());
  CheckState();
}

void World::CheckState() const {
  for (const int kind : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC}) {
    const mjWarningStat& warning = data_->warning[kind];
    if (warning.number > 0) {
      throw EpisodeFault(FaultCause::kDiverged,
                         fmt::format("{}: the simulation diverged: {}", source_,
                                     mju_warningText(kind, warning.lastinfo)));
    }
  }
}

}  // namespace shoal::worlds
