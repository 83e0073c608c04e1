// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/frozen_cameras.h"

#include <gtest/gtest.h>

#include <vector>

#include "common/base/random.h"
#include "replay_server/core/random_shift.h"

namespace shoal::learner {
namespace {

constexpr int kPad = 2;
constexpr int kStacks = 10;

ObservationSpec TwoCameras() {
  ObservationSpec spec;
  spec.cameras = {"a", "b"};
  spec.channels = 6;
  spec.height = 20;
  spec.width = 24;
  spec.stack = 2;
  return spec;
}

// kStacks random pictures of two cameras, where `frozen` marks cameras that show one picture
// always; shifted as the replay does.
std::vector<uint8_t> Stacks(bool first_frozen, bool second_frozen, int pad = kPad) {
  const ObservationSpec spec = TwoCameras();
  const size_t frame = size_t(spec.FrameBytes()), camera = frame / 2;
  Random random(7);
  std::vector<uint8_t> raw(frame * 2);
  std::vector<uint8_t> stacks(size_t{kStacks} * raw.size());
  for (int i = 0; i < kStacks; ++i) {
    for (size_t byte = 0; byte < raw.size(); ++byte) {
      const bool frozen = byte % frame < camera ? first_frozen : second_frozen;
      if (i == 0 || !frozen) raw[byte] = uint8_t(random.Next());
    }
    replay::ShiftPlanes(raw.data(), spec.stack * spec.channels, spec.height, spec.width,
                        replay::DrawShift(pad, &random), stacks.data() + size_t(i) * raw.size());
  }
  return stacks;
}

TEST(FrozenCameras, AreThoseThatShowOnePictureWhateverItsShift) {
  EXPECT_EQ(FrozenCameras(Stacks(false, false), TwoCameras(), kPad), 0);
  EXPECT_EQ(FrozenCameras(Stacks(true, false), TwoCameras(), kPad), 1);
  EXPECT_EQ(FrozenCameras(Stacks(false, true), TwoCameras(), kPad), 1);
  EXPECT_EQ(FrozenCameras(Stacks(true, true), TwoCameras(), kPad), 2);
  EXPECT_EQ(FrozenCameras(Stacks(true, true, 0), TwoCameras(), 0), 2);
}

TEST(FrozenCameras, OnePixelThatMovesIsEnough) {
  std::vector<uint8_t> stacks = Stacks(true, true, 0);
  const ObservationSpec spec = TwoCameras();
  const size_t frame = size_t(spec.FrameBytes());
  stacks[5 * 2 * frame + frame + size_t(10 * spec.width + 12)] ^= 1;  // stack 5, newest, camera 0
  EXPECT_EQ(FrozenCameras(stacks, spec, 0), 1);
}

TEST(FrozenCameras, NothingIsSaidWhereNothingCanBeCompared) {
  const std::vector<uint8_t> stacks = Stacks(true, true);
  const size_t one = stacks.size() / kStacks;
  EXPECT_EQ(FrozenCameras({stacks.data(), one}, TwoCameras(), kPad), 0);
  EXPECT_EQ(FrozenCameras(stacks, TwoCameras(), /*shift_pad=*/5), 0) << "padding up to the middle";
  EXPECT_EQ(FrozenCameras({}, ObservationSpec(), kPad), 0) << "without pixels";
}

}  // namespace
}  // namespace shoal::learner
