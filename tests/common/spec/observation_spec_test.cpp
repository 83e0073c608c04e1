// SPDX-License-Identifier: Apache-2.0
#include "common/spec/observation_spec.h"

#include <gtest/gtest.h>

namespace shoal {
namespace {

TEST(ObservationSpec, SaysInOneLineWhatIsSeenAndNothingOfWhatIsNot) {
  ObservationSpec spec;
  spec.task = "FetchReach";
  spec.blocks = {{"grip", 3}, {"hidden", 4, /*observed=*/false}, {"goal", 2}};
  spec.action_size = 4;
  spec.model_fingerprint = "1a2b";
  EXPECT_EQ(spec.Summary(), "FetchReach vector 5 [grip,goal], action 4, model 1a2b");
  spec.cameras = {"front", "side"};
  spec.channels = 6;
  spec.height = spec.width = 84;
  spec.stack = 2;
  EXPECT_EQ(spec.Summary(),
            "FetchReach pixels 6x84x84 [front,side] stack 2, vector 5 [grip,goal], action 4, model "
            "1a2b");
}

}  // namespace
}  // namespace shoal
