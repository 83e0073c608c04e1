// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/frame_figures.h"

#include <algorithm>

#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

TEST(FrameFigures, TellNoiseFromFramesOfOneColour) {
  const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, 3);
  UpdateFigures noise, equal;
  AddFrameFigures(batch.View(), SmallSpec(), 4, &noise);
  // Bytes uniform on 0..255 have deviation sqrt((256^2 - 1) / 12) = 73.9.
  EXPECT_NEAR(noise.Get(kFrameSpread).value(), 73.9, 3);
  EXPECT_EQ(noise.Get(kFrozenCameras), 0);
  std::ranges::fill(batch.View().obs_frames, uint8_t(90));
  AddFrameFigures(batch.View(), SmallSpec(), 2, &equal);
  EXPECT_EQ(equal.Get(kFrameSpread), 0);
  EXPECT_EQ(equal.Get(kFrozenCameras), 1);
}

TEST(FrameFigures, AreAbsentWithoutPixels) {
  ObservationSpec spec = SmallSpec();
  spec.cameras.clear();
  spec.channels = spec.height = spec.width = 0;
  ASSERT_FALSE(spec.HasPixels());
  const RandomBatch batch(spec, 4, 3);
  UpdateFigures figures;
  AddFrameFigures(batch.View(), spec, 4, &figures);
  EXPECT_TRUE(figures.empty());
}

}  // namespace
}  // namespace shoal::learner
