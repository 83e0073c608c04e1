// SPDX-License-Identifier: Apache-2.0
#include "tests/actor/worlds/pictures/picture_comparison.h"

#include <fmt/core.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "actor/worlds/abstract_scene.h"
#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/episode_fault.h"
#include "actor/worlds/native/renderer.h"
#include "actor/worlds/world_registry.h"
#include "common/tasks/task_registry.h"
#include "tests/actor/worlds/pictures/unshadowed_reference.h"

namespace shoal::worlds {
namespace {

constexpr size_t kPixels = size_t{kPictureSide} * kPictureSide;
constexpr uint64_t kSeed = 11;

double MeanDifference(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::abs(int{a[i]} - int{b[i]});
  return sum / static_cast<double>(a.size());
}

// A geom or site of the model: type of object, then its number.
using Part = std::pair<int, int>;
constexpr Part kSky{mjOBJ_UNKNOWN, -1};

std::string NameOf(const mjModel& model, const Part& part) {
  const auto [type, id] = part;
  const char* name = mj_id2name(&model, type, id);
  const char* kind = type == mjOBJ_SITE ? "site" : "geom";
  if (name != nullptr && *name != '\0') return fmt::format("{} {}", kind, name);
  const int body_id = type == mjOBJ_SITE ? model.site_bodyid[id] : model.geom_bodyid[id];
  const char* body = mj_id2name(&model, mjOBJ_BODY, body_id);
  const int first = type == mjOBJ_SITE ? 0 : model.body_geomadr[body_id];
  return fmt::format("{} {} of {}", kind, id - first, body == nullptr ? "" : body);
}

bool Moves(const mjModel& model, const Part& part) {
  const auto [type, id] = part;
  if (id < 0) return false;
  return (type == mjOBJ_SITE ? model.site_bodyid[id] : model.geom_bodyid[id]) != 0;
}

// Both sides of one task's pictures.
class Sides {
 public:
  explicit Sides(World* world)
      : world_(world), engine_(&world->model(), kPictureSide, kPictureSide), ours_(world->model()) {
    scene_.Allocate(*world);
  }

  void Look(const CameraView& camera) { scene_.Update(world_, camera); }
  std::vector<uint8_t> Engine() { return engine_.Draw(&scene_.scene()); }
  std::vector<uint8_t> Ours() {
    std::vector<uint8_t> planes(3 * kPixels);
    ours_.Draw(scene_.scene(), kPictureSide, kPictureSide, planes);
    return planes;
  }
  std::vector<Part> EngineParts() {
    std::map<int, Part> of_segment;
    const mjvScene& scene = scene_.scene();
    for (int i = 0; i < scene.ngeom; ++i) of_segment[scene.geoms[i].segid] = PartOf(i);
    std::vector<Part> parts;
    for (const int segment : engine_.DrawSegments(&scene_.scene())) {
      parts.push_back(segment < 0 ? kSky : of_segment.at(segment));
    }
    return parts;
  }
  std::vector<Part> OurParts() {
    std::vector<int32_t> numbers(kPixels);
    ours_.DrawNumbers(scene_.scene(), kPictureSide, kPictureSide, numbers);
    std::vector<Part> parts;
    for (const int32_t number : numbers) parts.push_back(number < 0 ? kSky : PartOf(number));
    return parts;
  }

 private:
  Part PartOf(int number) {
    const mjvGeom& geom = scene_.scene().geoms[number];
    return {geom.objtype, geom.objid};
  }

  World* world_;
  native::UnshadowedReference engine_;
  native::Renderer ours_;
  AbstractScene scene_;
};

// Adds up one camera's states.
class CameraSum {
 public:
  CameraSum(const std::string& task, const std::string& camera) {
    sum_.task = task;
    sum_.camera = camera;
  }

  void Add(Sides* sides, const mjModel& model) {
    const double difference = MeanDifference(sides->Engine(), sides->Ours());
    sum_.mean_difference += difference;
    sum_.most_difference = std::max(sum_.most_difference, difference);
    std::map<Part, PartAgreement> here;
    const std::vector<Part> engine = sides->EngineParts(), ours = sides->OurParts();
    double same = 0;
    for (size_t i = 0; i < kPixels; ++i) {
      ++here[engine[i]].engine;
      ++here[ours[i]].ours;
      if (engine[i] == ours[i]) {
        ++here[engine[i]].both;
        ++same;
      }
      const bool moves = Moves(model, engine[i]);
      both_moving_ += moves && engine[i] == ours[i];
      either_moving_ += moves || Moves(model, ours[i]);
    }
    const double overlap = same / (2 * static_cast<double>(kPixels) - same);
    sum_.mean_overlap += overlap;
    sum_.least_overlap = std::min(sum_.least_overlap, overlap);
    ++sum_.states;
    for (const auto& [part, found] : here) {
      PartAgreement& all = parts_[part];
      all.engine += found.engine;
      all.ours += found.ours;
      all.both += found.both;
      all.states += found.engine >= kShownPixels;
      all.missed += found.engine >= kShownPixels && found.ours == 0;
    }
  }

  CameraComparison Result(const mjModel& model) {
    sum_.mean_difference /= sum_.states;
    sum_.mean_overlap /= sum_.states;
    if (either_moving_ > 0) {
      sum_.moving_overlap = static_cast<double>(both_moving_) / static_cast<double>(either_moving_);
    }
    for (auto& [part, agreement] : parts_) {
      if (part == kSky) continue;
      agreement.name = NameOf(model, part);
      sum_.parts.push_back(agreement);
    }
    std::ranges::sort(sum_.parts, {}, &PartAgreement::name);
    return sum_;
  }

 private:
  CameraComparison sum_;
  std::map<Part, PartAgreement> parts_;
  int64_t both_moving_ = 0, either_moving_ = 0;
};

double Rounded(double value) { return std::round(value * 1e4) / 1e4; }

nlohmann::ordered_json PartJson(const PartAgreement& part) {
  return {{"name", part.name},
          {"states", part.states},
          {"missed", part.missed},
          {"overlap", Rounded(part.overlap())}};
}

}  // namespace

RandomStates::RandomStates(const std::string& task, uint64_t seed)
    : task_(tasks::FindTask(task)), world_(MakeWorld(task_.world(), {})), random_(seed) {
  Reset();
}

void RandomStates::Next() {
  std::vector<double> action(static_cast<size_t>(task_.action_size()));
  for (int step = 0; step < 3; ++step) {
    for (double& component : action) component = random_.Uniform(-1, 1);
    bool over = ++steps_ >= task_.episode_length();
    try {
      over = world_->Step(action).terminated || over;
    } catch (const EpisodeFault&) {
      world_->ForgetDivergence();
      over = true;
    }
    if (over) Reset();
  }
}

void RandomStates::Reset() {
  steps_ = 0;
  world_->Reset(&random_);
}

double PartAgreement::overlap() const {
  const int64_t either = engine + ours - both;
  return either == 0 ? 1 : static_cast<double>(both) / static_cast<double>(either);
}

std::vector<CameraComparison> ComparePictures(const std::string& task, int states) {
  RandomStates random(task, kSeed);
  Sides sides(random.world());
  std::vector<CameraComparison> comparisons;
  for (const CameraView& camera : CamerasOf(*random.world())) {
    CameraSum sum(task, camera.name);
    for (int i = 0; i < states; ++i) {
      random.Next();
      sides.Look(camera);
      sum.Add(&sides, random.world()->model());
    }
    comparisons.push_back(sum.Result(random.world()->model()));
  }
  return comparisons;
}

std::vector<std::string> TasksOfAllWorlds() {
  std::vector<std::string> chosen;
  std::set<std::string> worlds;
  for (const std::string& name : tasks::TaskNames()) {
    if (worlds.insert(tasks::FindTask(name).world()).second) chosen.push_back(name);
  }
  return chosen;
}

bool IsFingerOrMarker(const PartAgreement& part) {
  return part.name.find("finger") != std::string::npos ||
         part.name.find("target") != std::string::npos;
}

std::vector<PartAgreement> TellingParts(const CameraComparison& comparison) {
  std::vector<PartAgreement> telling;
  const PartAgreement* least = nullptr;
  for (const PartAgreement& part : comparison.parts) {
    const bool small = part.engine < int64_t{kShownPixels} * part.states || part.states == 0;
    if (IsFingerOrMarker(part)) {
      telling.push_back(part);
    } else if (!small && (least == nullptr || part.overlap() < least->overlap())) {
      least = &part;
    }
  }
  if (least != nullptr) telling.push_back(*least);
  return telling;
}

nlohmann::ordered_json ToJson(const std::vector<CameraComparison>& comparisons) {
  nlohmann::ordered_json cameras = nlohmann::ordered_json::array();
  for (const CameraComparison& c : comparisons) {
    nlohmann::ordered_json parts = nlohmann::ordered_json::array();
    for (const PartAgreement& part : TellingParts(c)) parts.push_back(PartJson(part));
    int missed = 0;
    for (const PartAgreement& part : c.parts) missed += part.missed;
    cameras.push_back({{"task", c.task},
                       {"camera", c.camera},
                       {"states", c.states},
                       {"mean_difference", Rounded(c.mean_difference)},
                       {"most_difference", Rounded(c.most_difference)},
                       {"mean_overlap", Rounded(c.mean_overlap)},
                       {"least_overlap", Rounded(c.least_overlap)},
                       {"moving_overlap", Rounded(c.moving_overlap)},
                       {"missed_parts", missed},
                       {"parts", parts}});
  }
  return {{"schema", "shoal-pictures-1"}, {"side", kPictureSide}, {"cameras", cameras}};
}

PictureStrip DrawStrip(const std::vector<std::string>& tasks) {
  constexpr size_t kSide = kPictureSide, kGap = 4;
  PictureStrip strip;
  const size_t width = tasks.size() * (kSide + kGap) - kGap, height = 2 * kSide + kGap;
  strip.width = static_cast<int>(width);
  strip.height = static_cast<int>(height);
  strip.pixels.assign(3 * width * height, 255);
  for (size_t column = 0; column < tasks.size(); ++column) {
    RandomStates random(tasks[column], kSeed);
    for (int i = 0; i < 5; ++i) random.Next();
    Sides sides(random.world());
    sides.Look(CamerasOf(*random.world()).front());
    size_t top = 0;
    for (const std::vector<uint8_t>& planes : {sides.Engine(), sides.Ours()}) {
      for (size_t i = 0; i < kPixels; ++i) {
        const size_t to = (top + i / kSide) * width + column * (kSide + kGap) + i % kSide;
        for (size_t c = 0; c < 3; ++c) strip.pixels[3 * to + c] = planes[c * kPixels + i];
      }
      top += kSide + kGap;
    }
  }
  return strip;
}

}  // namespace shoal::worlds
