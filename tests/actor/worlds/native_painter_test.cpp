// SPDX-License-Identifier: Apache-2.0
// The painter of quality native.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/fetch_reach.h"
#include "actor/worlds/painter.h"
#include "common/base/random.h"
#include "common/config/config.h"

namespace shoal::worlds {
namespace {

class NativePainterTest : public testing::Test {
 protected:
  NativePainterTest() {
    Random random(3);
    world_->Reset(&random);
  }
  std::vector<uint8_t> Draw(int width, int height, PainterOutput output = PainterOutput::kColours,
                            const char* camera = "front", bool grey = false) {
    ObservationConfig observation;
    observation.quality = "native";
    observation.width = width;
    observation.height = height;
    observation.grey = grey;
    const std::unique_ptr<Painter> painter = MakeNativePainter(observation);
    painter->TakeModel(world_.get());
    painter->SetOutput(output);
    std::vector<uint8_t> planes(size_t(grey ? 1 : 3) * size_t(width) * size_t(height));
    painter->Draw(world_.get(), FindCamera(*world_, camera), planes);
    return planes;
  }

  std::unique_ptr<World> world_ = MakeFetchReach({});
};

// Every fifth pixel of the large picture has the ray of a pixel of the small one. Textures are
// sharper in the large one.
TEST_F(NativePainterTest, FilmsInFullHdShowWhatSmallPicturesShow) {
  constexpr size_t kWidth = 1920, kHeight = 1080, kShare = 5;
  const std::vector<uint8_t> large = Draw(kWidth, kHeight);
  const std::vector<uint8_t> small = Draw(kWidth / kShare, kHeight / kShare);
  const size_t plane = small.size() / 3;
  double difference = 0;
  for (size_t i = 0; i < small.size(); ++i) {
    const size_t channel = i / plane, row = i % plane / (kWidth / kShare);
    const size_t column = i % plane % (kWidth / kShare);
    const size_t at = channel * kWidth * kHeight + (row * kShare + kShare / 2) * kWidth +
                      column * kShare + kShare / 2;
    difference += std::abs(int{large[at]} - int{small[i]});
  }
  EXPECT_LT(difference / double(small.size()), 0.5);
  EXPECT_GT(*std::ranges::max_element(large), 100) << "a black picture";
}

TEST_F(NativePainterTest, GreyPicturesHaveOneChannelOfEachOutput) {
  for (const auto output :
       {PainterOutput::kColours, PainterOutput::kSegments, PainterOutput::kDepths}) {
    const std::vector<uint8_t> colours = Draw(32, 24, output);
    const std::vector<uint8_t> grey = Draw(32, 24, output, "front", /*grey=*/true);
    ASSERT_EQ(grey.size() * 3, colours.size());
    for (size_t i = 0; i < grey.size(); ++i) {
      const double luma = 0.299 * colours[i] + 0.587 * colours[i + grey.size()] +
                          0.114 * colours[i + 2 * grey.size()];
      ASSERT_NEAR(grey[i], luma, 1.5);
    }
  }
}

// Segments and depths have the same edges as what they belong to.
TEST_F(NativePainterTest, SegmentsAndDepthsAreThoseOfTheScene) {
  constexpr size_t kPixelsOf64 = 64 * 64;
  const std::vector<uint8_t> segments = Draw(64, 64, PainterOutput::kSegments);
  const std::vector<uint8_t> depths = Draw(64, 64, PainterOutput::kDepths);
  std::set<int> colours;
  for (size_t i = 0; i < kPixelsOf64; ++i) {
    const int colour =
        segments[i] | segments[i + kPixelsOf64] << 8 | segments[i + 2 * kPixelsOf64] << 16;
    colours.insert(colour);
    ASSERT_EQ(colour == 0, depths[i] == 0) << "sky in one of them, pixel " << i;
    ASSERT_EQ(depths[i], depths[i + kPixelsOf64]);
  }
  EXPECT_GT(colours.size(), 10u);
  EXPECT_EQ(*std::ranges::max_element(depths), 255);
}

}  // namespace
}  // namespace shoal::worlds
