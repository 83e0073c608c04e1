#include "learner/agent/batch_part.h"

#include <gtest/gtest.h>

#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

TEST(PartOf, PartsInARowAreTheBatch) {
  const RandomBatch random(SmallSpec(), BatchOptions{.batch = 6, .rollout = true}, 3);
  BatchView whole = random.View();
  whole.stored_steps = 70;
  for (const int parts : {1, 2, 3}) {
    for (int i = 0; i < parts; ++i) {
      const BatchView part = PartOf(whole, i, parts);
      const auto expect_part = [&](auto member) {
        const auto all = whole.*member, own = part.*member;
        EXPECT_EQ(own.size(), all.size() / size_t(parts));
        EXPECT_EQ(own.data(), all.data() + own.size() * size_t(i));
      };
      expect_part(&BatchView::obs_frames);
      expect_part(&BatchView::next_obs_frames);
      expect_part(&BatchView::obs_vector);
      expect_part(&BatchView::next_obs_vector);
      expect_part(&BatchView::action);
      expect_part(&BatchView::reward);
      expect_part(&BatchView::bootstrap);
      expect_part(&BatchView::obs_privileged);
      expect_part(&BatchView::next_obs_privileged);
      expect_part(&BatchView::weights_update);
      expect_part(&BatchView::id);
      expect_part(&BatchView::drawn_action);
      expect_part(&BatchView::log_prob);
      expect_part(&BatchView::ends);
      expect_part(&BatchView::continues);
      EXPECT_EQ(part.stored_steps, 70u);
    }
  }
}

}  // namespace
}  // namespace shoal::learner
