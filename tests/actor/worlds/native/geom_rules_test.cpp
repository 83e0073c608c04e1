// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/geom_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/actor/worlds/native/scene_by_hand.h"

namespace shoal::worlds::native {
namespace {

using testing::HasSubstr;

TEST(GeomRules, ScenesWithFogAreRefused) {
  SceneByHand hand;
  CheckFlags(hand.scene());
  hand.scene().flags[mjRND_FOG] = 1;
  try {
    CheckFlags(hand.scene());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("fog"));
    EXPECT_THAT(error.what(), HasSubstr("reference"));
  }
}

}  // namespace
}  // namespace shoal::worlds::native
