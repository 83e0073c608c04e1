// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/problem_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/log.h"

namespace shoal::replay {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

ObservationSpec ActionSpec() {
  ObservationSpec spec;
  spec.action_size = 2;
  return spec;
}

class ProblemLogTest : public testing::Test {
 protected:
  ProblemLogTest() { log::Start("test", ""); }
  std::string Report(SteadyTime now, uint64_t dropped_chunks = 0) {
    testing::internal::CaptureStderr();
    log_.Report(now, counters_, dropped_chunks);
    return testing::internal::GetCapturedStderr();
  }

  const SteadyTime start_ = Now();
  CoreCounters counters_;
  const BatchSchema schema_{ActionSpec(), {.batch = 8}};
  ProblemLog log_{0xabc, schema_};
};

TEST_F(ProblemLogTest, IsSilentWithoutProblems) {
  EXPECT_THAT(Report(start_), IsEmpty());
  EXPECT_THAT(Report(start_ + IntakeProblems::kInterval), IsEmpty());
}

TEST_F(ProblemLogTest, NamesBothSchemasOfARefusedRequest) {
  SampleRequest request;
  request.spec_hash = 0xabc;
  request.schema_hash = 0x123;
  log_.NoteRefused(request);
  counters_.refused_requests = 1;
  EXPECT_THAT(Report(start_), HasSubstr(fmt::format("schema 0000000000000123 (the run's {:016x}: "
                                                    "batch 8, copies 1, n_step 1, discount 1: "
                                                    "action f32 2, reward f32",
                                                    schema_.Hash())));
}

TEST_F(ProblemLogTest, TellsOfTheIntakeToo) {
  counters_.intake.after_gap = 3;
  const std::string lines = Report(start_, /*dropped_chunks=*/5);
  EXPECT_THAT(lines, HasSubstr("3 records not used"));
  EXPECT_THAT(lines, HasSubstr("5 chunks dropped"));
}

}  // namespace
}  // namespace shoal::replay
