// SPDX-License-Identifier: Apache-2.0
// Compares pictures of quality native with pictures of the engine's own renderer.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "actor/worlds/camera_view.h"
#include "actor/worlds/world.h"
#include "common/base/random.h"
#include "common/tasks/task.h"

namespace shoal::worlds {

constexpr int kPictureSide = 84;

// A world under random actions, reset at the end of each episode.
class RandomStates {
 public:
  RandomStates(const std::string& task, uint64_t seed);

  World* world() { return world_.get(); }
  // Plays three env steps.
  void Next();

 private:
  void Reset();

  const tasks::Task& task_;
  std::unique_ptr<World> world_;
  Random random_;
  int steps_ = 0;
};

// Agreement about one geom or site, over all states.
struct PartAgreement {
  std::string name;
  int states = 0;  // states in which the engine shows at least kShownPixels
  int missed = 0;  // those of `states` in which quality native shows no pixel
  int64_t engine = 0, ours = 0, both = 0;  // pixels of the part: engine's, native's, in both

  double overlap() const;  // intersection over union
};
constexpr int kShownPixels = 4;

// Differences of colours are means of |a - b| over all channels of a picture, in grey levels.
struct CameraComparison {
  std::string task, camera;
  int states = 0;
  double mean_difference = 0, most_difference = 0;
  // Intersection over union of the segments, over all states: mean and least value of a picture
  // with all segments, and value of the segments of moving bodies.
  double mean_overlap = 0, least_overlap = 1, moving_overlap = 1;
  std::vector<PartAgreement> parts;  // parts that at least one renderer shows, sorted by name
};

// Draws `states` random states with each of the task's cameras.
std::vector<CameraComparison> ComparePictures(const std::string& task, int states);

// One task of each physics half.
std::vector<std::string> TasksOfAllWorlds();

bool IsFingerOrMarker(const PartAgreement& part);

// Fingers, goal markers and, of the other parts with a mean of at least kShownPixels, the part that
// agrees least.
std::vector<PartAgreement> TellingParts(const CameraComparison& comparison);

// Schema shoal-pictures-1: {schema, side, cameras: [...]}.
nlohmann::ordered_json ToJson(const std::vector<CameraComparison>& comparisons);

// RGB (H, W, 3): pictures of tasks side by side, from the first camera of each task. The engine's
// pictures are above those of quality native.
struct PictureStrip {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels;
};
PictureStrip DrawStrip(const std::vector<std::string>& tasks);

}  // namespace shoal::worlds
