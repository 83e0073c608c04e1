// SPDX-License-Identifier: Apache-2.0
// A point on a line. Each step looks for a file CRASH_FOLDER/NAME, where the variable
// SHOAL_TEST_CRASH_FOLDER names the folder and NAME is that of the process: "actor-1", "eval".
// While the file exists, the process crashes as with a null pointer. A step takes three
// milliseconds, so that a waiting run leaves the processors to others.
#include <mujoco/mujoco.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "actor/worlds/model_text.h"
#include "actor/worlds/world.h"
#include "actor/worlds/world_registry.h"
#include "common/base/random.h"

namespace {

using shoal::worlds::CameraView;

constexpr char kModel[] = R"(
<mujoco model="point">
  <option timestep="0.01"/>
  <worldbody>
    <body name="point">
      <joint name="x" type="slide" axis="1 0 0" damping="1"/>
      <geom type="sphere" size="0.04" mass="0.1"/>
    </body>
  </worldbody>
  <actuator><motor joint="x" ctrlrange="-1 1" ctrllimited="true"/></actuator>
</mujoco>)";

// The file that makes this process crash if it exists; empty = none.
std::filesystem::path CrashFile() {
  const char* folder = std::getenv("SHOAL_TEST_CRASH_FOLDER");
  if (folder == nullptr) return {};
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::string name = "none";
  for (std::string word, before; std::getline(in, word, '\0'); before = word) {
    if (before == "--id") name = "actor-" + word;
    if (before == "--role") name = word;
  }
  return std::filesystem::path(folder) / name;
}

class CrashingPoint final : public shoal::worlds::World {
 public:
  explicit CrashingPoint(const shoal::worlds::WorldOptions& options)
      : World(shoal::worlds::LoadModelText(kModel, options.model)) {}

  void Reset(shoal::Random* random) override {
    mj_resetData(&model(), &data());
    goal_ = random->Uniform(-0.3, 0.3);
    mj_forward(&model(), &data());
  }

  Outcome Step(std::span<const double> action) override {
    if (!crash_file_.empty() && std::filesystem::exists(crash_file_)) std::raise(SIGSEGV);
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
    data().ctrl[0] = action[0];
    Advance(4);
    return {};
  }

  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override {
    observation[0] = achieved_goal[0] = data().qpos[0];
    desired_goal[0] = goal_;
  }

  std::span<const CameraView> cameras() const override {
    static const CameraView top{"top", {0, 0, 0}, 1.6, 90, -90};
    return {&top, 1};
  }

 private:
  const std::filesystem::path crash_file_ = CrashFile();
  double goal_ = 0;
};

std::unique_ptr<shoal::worlds::World> MakePhysicsHalf(const shoal::worlds::WorldOptions& options) {
  return std::make_unique<CrashingPoint>(options);
}

}  // namespace

extern "C" void ShoalRegisterPhysics() {
  shoal::worlds::AddWorld("CrashingPoint", MakePhysicsHalf);
}
