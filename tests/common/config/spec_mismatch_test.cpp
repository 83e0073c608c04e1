// SPDX-License-Identifier: Apache-2.0
#include "common/config/spec_mismatch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shoal {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

RunConfig RunOfPoint() {
  RunConfig run;
  run.config.task = "PointReachDense";
  run.spec.task = run.config.task;
  run.spec.blocks = {{"position", 2}};
  run.spec.model_fingerprint = "0123";
  return run;
}

TEST(SpecMismatch, AChangedModelIsNamedByItsFile) {
  RunConfig run = RunOfPoint();
  ObservationSpec now = run.spec;
  now.model_fingerprint = "4567";
  EXPECT_THAT(SpecMismatch(run, now),
              AllOf(HasSubstr("the model of task PointReachDense has changed since the run began"),
                    Not(HasSubstr("4567"))));
  run.config.task_library = "/tasks/point.so";
  EXPECT_THAT(SpecMismatch(run, now), HasSubstr("(task library '/tasks/point.so') has changed"));
  run.config.model = "/models/arm.xml";
  EXPECT_THAT(SpecMismatch(run, now),
              HasSubstr("model file '/models/arm.xml' has changed since the run began"));
}

TEST(SpecMismatch, AnythingElseNamesBothObservations) {
  const RunConfig run = RunOfPoint();
  ObservationSpec now = run.spec;
  now.model_fingerprint = "4567";
  now.blocks[0].size = 3;
  EXPECT_THAT(SpecMismatch(run, now), AllOf(HasSubstr(run.spec.Summary()), HasSubstr(now.Summary()),
                                            Not(HasSubstr("has changed"))));
}

}  // namespace
}  // namespace shoal
