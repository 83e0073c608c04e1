// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/newer_mjcf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "actor/worlds/model_text.h"
#include "tests/support/error_message.h"

namespace shoal::worlds {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string RefusalOf(const std::string& mjcf) {
  return ErrorMessage([&] { LoadModelText("<mujoco>" + mjcf + "</mujoco>", ""); });
}

TEST(WithNewerMjcf, AWordOfANewerMjcfIsNamedWithItsVersion) {
  const struct {
    const char *mjcf, *word, *since;
  } cases[] = {
      {R"(<option integrator="implicitfast"/>)", "implicitfast", "2.3.3"},
      {R"(<worldbody><body><joint actuatorfrcrange="-1 1"/><geom size="1"/></body></worldbody>)",
       "actuatorfrcrange", "2.3.7"},
      {R"(<worldbody><frame pos="0 0 1"><geom size="1"/></frame></worldbody>)", "frame", "3.1.0"},
      {R"(<asset><texture name="a" type="2d" colorspace="sRGB"/></asset>)", "colorspace", "3.3.3"},
      {R"(<option><flag eulerdamp="disable"/></option>)", "eulerdamp", "3.0.0"},
      {R"(<worldbody><light type="spot"/></worldbody>)", "type", "3.3.3"},
      {R"(<compiler assetdir="x"/>)", "assetdir", "2.3.0"},
  };
  for (const auto& [mjcf, word, since] : cases) {
    const std::string refusal = RefusalOf(mjcf);
    EXPECT_THAT(refusal, HasSubstr(std::string("MuJoCo has '") + word + "' since " + since +
                                   ", Shoal's engine is 2.2.2"));
    EXPECT_THAT(refusal, Not(HasSubstr("\n")));
    EXPECT_THAT(refusal, HasSubstr("line 1"));
  }
}

TEST(WithNewerMjcf, WhatTheEngineDoesNotKnowInAnyVersionStaysItsOwnReason) {
  EXPECT_THAT(RefusalOf(R"(<option speed="3"/>)"),
              AllOf(HasSubstr("unrecognized attribute: 'speed'"), Not(HasSubstr("since"))));
  // Known of a light, not of a site.
  EXPECT_THAT(RefusalOf(R"(<contact><exclude type="spot"/></contact>)"),
              AllOf(HasSubstr("unrecognized attribute: 'type'"), Not(HasSubstr("since"))));
  EXPECT_THAT(RefusalOf("<worldbody>"), Not(HasSubstr("since")));
}

}  // namespace
}  // namespace shoal::worlds
