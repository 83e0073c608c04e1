// A cart on a rail is to stop under a light. Its velocity obeys the action with a delay. No physics
// engine: the arithmetic is here.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "actor/hosted/environment_library.h"
#include "common/base/random.h"

namespace {

using shoal::hosted::RawPicture;
using shoal::hosted::RawStep;

constexpr double kRail = 1;
constexpr int kSteps = 100;

class CatchLight final : public shoal::hosted::OwnEnvironment {
 public:
  shoal::tasks::EnvironmentDescription Describe() const override {
    shoal::tasks::EnvironmentDescription description;
    description.episode_steps = kSteps;
    description.action = {.name = "force", .shape = {1}, .low = {-2}, .high = {2}};
    description.observation = {{.name = "cart", .shape = {2}, .low = {-10}, .high = {10}},
                               {.name = "light", .shape = {1}, .low = {-kRail}, .high = {kRail}}};
    description.success = true;
    return description;
  }

  void Reset(uint32_t seed) override {
    shoal::Random random(seed);
    cart_ = {static_cast<float>(random.Uniform(-kRail, kRail)), 0};
    light_ = static_cast<float>(random.Uniform(-kRail, kRail));
    steps_ = 0;
  }

  RawStep Step(std::span<const double> action) override {
    auto& [place, velocity] = cart_;
    velocity += static_cast<float>(0.1 * action[0]) - 0.1F * velocity;
    place = std::clamp(place + 0.1F * velocity, -10.F, 10.F);
    const double distance = std::fabs(place - light_);
    return {.reward = -distance, .truncated = ++steps_ == kSteps, .success = distance < 0.1};
  }

  // In the order of the description.
  std::span<const void* const> observation() const override { return arrays_; }

  RawPicture Render() override {
    RawPicture picture{.height = 64, .width = 192, .pixels = {}};
    picture.pixels.assign(size_t{64} * 192 * 3, 40);
    Draw(&picture, light_, {255, 220, 0});
    Draw(&picture, cart_[0], {80, 160, 255});
    return picture;
  }

 private:
  static void Draw(RawPicture* picture, float place, std::array<uint8_t, 3> colour) {
    const int column = std::clamp(static_cast<int>(96 + 40 * place), 4, 187);
    for (int y = 20; y < 44; ++y) {
      for (int x = column - 4; x < column + 4; ++x) {
        std::ranges::copy(colour,
                          &picture->pixels[static_cast<size_t>(3 * (y * picture->width + x))]);
      }
    }
  }

  std::array<float, 2> cart_{};  // place, velocity
  float light_ = 0;
  int steps_ = 0;
  std::array<const void*, 2> arrays_{cart_.data(), &light_};
};

std::unique_ptr<shoal::hosted::OwnEnvironment> Make(const std::string& /*kwargs*/) {
  return std::make_unique<CatchLight>();
}

}  // namespace

extern "C" void ShoalRegisterEnvironments() { shoal::hosted::AddEnvironment("CatchLight", Make); }
