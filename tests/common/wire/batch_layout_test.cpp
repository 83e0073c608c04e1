#include "common/wire/batch_layout.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

namespace shoal {
namespace {

struct Free {
  void operator()(uint8_t* p) const { std::free(p); }
};

TEST(BatchLayout, ArraysAreAlignedDisjointAndInside) {
  ObservationSpec spec;
  spec.channels = 3;
  spec.height = 5;
  spec.width = 7;
  spec.stack = 2;
  spec.blocks = {{"observation", 3}};
  spec.action_size = 4;
  const BatchLayout layout(spec, 3);
  EXPECT_EQ(layout.frame_stack_bytes(), 2 * 3 * 5 * 7);
  const std::unique_ptr<uint8_t, Free> memory(
      static_cast<uint8_t*>(std::aligned_alloc(64, layout.total_bytes())));
  const BatchView view = layout.View(memory.get());
  EXPECT_EQ(view.obs_frames.size(), 3u * 210);
  EXPECT_EQ(view.next_obs_frames.size(), 3u * 210);
  EXPECT_EQ(view.obs_vector.size(), 9u);
  EXPECT_EQ(view.action.size(), 12u);
  EXPECT_EQ(view.reward.size(), 3u);
  EXPECT_EQ(view.weights_update.size(), 3u);

  const uint8_t* end = memory.get();
  const auto check = [&](const auto& array) {
    const auto* begin = reinterpret_cast<const uint8_t*>(array.data());
    EXPECT_EQ((begin - memory.get()) % 64, 0);
    EXPECT_GE(begin, end);
    end = begin + array.size_bytes();
  };
  check(view.obs_frames);
  check(view.next_obs_frames);
  check(view.obs_vector);
  check(view.next_obs_vector);
  check(view.action);
  check(view.reward);
  check(view.bootstrap);
  check(view.weights_update);
  EXPECT_LE(end, memory.get() + layout.total_bytes());
}

}  // namespace
}  // namespace shoal
