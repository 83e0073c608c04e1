// SPDX-License-Identifier: Apache-2.0
// Compares Shoal's frames with frames of the original environments with their own meshes.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/fetch_world.h"
#include "actor/worlds/render_context.h"
#include "actor/worlds/tools/reference_file.h"
#include "actor/worlds/world_registry.h"
#include "common/base/files.h"
#include "tests/support/paths.h"

namespace shoal::worlds {
namespace {

constexpr int kSide = 84;
constexpr size_t kPlane = kSide * kSide;
const std::string kFolder = GoldenPath("reference/fetch_");

using Frame = std::vector<uint8_t>;  // (3, 84, 84)

struct Case {
  const char* task;      // without "Fetch"
  const char* sequence;  // whose actions lead to the frames
  size_t frames;         // recorded
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.task; }

struct Recorded {
  int after_step = 0;
  Frame frame;
};

std::vector<uint8_t> DecodeBase64(const std::string& text) {
  static const std::string kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<uint8_t> bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char letter : text) {
    const size_t digit = kDigits.find(letter);
    if (digit == std::string::npos) break;  // padding
    bits = (bits << 6) | static_cast<uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<uint8_t>(bits >> count));
  }
  return bytes;
}

std::vector<Recorded> ReadFrames(const char* task) {
  const auto document =
      nlohmann::json::parse(ReadFile(fmt::format("{}{}_frames_84.json", kFolder, task)));
  std::vector<Recorded> recorded;
  for (const auto& entry : document.at("frames")) {
    const std::vector<uint8_t> pixels = DecodeBase64(entry.at("rgb_base64"));
    Recorded& frame = recorded.emplace_back();
    frame.after_step = entry.at("after_step");
    frame.frame.resize(3 * kPlane);
    for (size_t i = 0; i < 3 * kPlane; ++i) frame.frame[i % 3 * kPlane + i / 3] = pixels.at(i);
  }
  return recorded;
}

// Mean absolute difference in grey levels, over all channels.
double ErrorOf(const Case& c, const Recorded& recorded, const std::string& quality) {
  const ReferenceTrajectory trajectory =
      ReadReference(fmt::format("{}{}_{}.json", kFolder, c.task, c.sequence));
  const std::unique_ptr<World> made = MakeWorld(trajectory.task, {});
  auto& world = dynamic_cast<FetchWorld&>(*made);
  world.ResetTo(trajectory.desired_goal, trajectory.object_xy);
  for (int i = 0; i < recorded.after_step; ++i) {
    world.Step(trajectory.steps[static_cast<size_t>(i)].action);
  }
  ObservationConfig observation;
  observation.quality = quality;
  RenderContext context(observation);
  context.Attach(&world);
  Frame ours(3 * kPlane);
  const CameraView camera = FindCamera(world, "gymnasium");
  context.Render(&world, {&camera, 1}, ours);
  double sum = 0;
  for (size_t i = 0; i < ours.size(); ++i) sum += std::abs(int{ours[i]} - int{recorded.frame[i]});
  return sum / static_cast<double>(ours.size());
}

class FrameParity : public testing::TestWithParam<Case> {
 protected:
  void ExpectAtMost(double limit, const std::string& quality) {
    const std::vector<Recorded> recorded = ReadFrames(GetParam().task);
    ASSERT_EQ(recorded.size(), GetParam().frames);
    for (const Recorded& frame : recorded) {
      const double error = ErrorOf(GetParam(), frame, quality);
      EXPECT_LE(error, limit) << "after step " << frame.after_step;
      std::cout << fmt::format("{} {} after {:2}: {:.2f} grey levels\n", GetParam().task, quality,
                               frame.after_step, error);
    }
  }
};

TEST_P(FrameParity, ReferenceFramesLookLikeTheOriginals) { ExpectAtMost(2.5, "reference"); }
TEST_P(FrameParity, NativeFramesLookAlmostLikeTheOriginals) { ExpectAtMost(5, "native"); }
TEST_P(FrameParity, FastFramesLookAlmostLikeTheOriginals) { ExpectAtMost(5, "fast"); }

// The actions between Push's two recorded frames are not known, so only its first is compared.
INSTANTIATE_TEST_SUITE_P(Fetch, FrameParity,
                         testing::Values(Case{"Reach", "random_hold5", 2}, Case{"Push", "zero", 1},
                                         Case{"Slide", "scripted", 2},
                                         Case{"PickAndPlace", "scripted", 2}));

}  // namespace
}  // namespace shoal::worlds
