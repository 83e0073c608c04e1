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
  EXPECT_THAT(Report(start_ + ProblemLog::kInterval), IsEmpty());
}

TEST_F(ProblemLogTest, NamesBothSpecsOncePerInterval) {
  TransitionChunk chunk;
  chunk.actor = 4;
  chunk.spec_hash = 0xdef;
  log_.Note(chunk, {.fate = ChunkFate::kWrongSpec});
  counters_.wrong_spec_chunks = 2;
  EXPECT_THAT(Report(start_), HasSubstr("2 chunks refused: actor 4 has observation spec "
                                        "0000000000000def, the run has 0000000000000abc"));
  counters_.wrong_spec_chunks = 5;
  EXPECT_THAT(Report(start_ + ProblemLog::kInterval / 2), IsEmpty());
  EXPECT_THAT(Report(start_ + ProblemLog::kInterval), HasSubstr("3 chunks refused"));
}

TEST_F(ProblemLogTest, NamesTheFaultOfRejectedRecords) {
  ChunkResult result;
  result.rejected = 1;
  result.fault = "reward is not finite";
  log_.Note({}, result);
  counters_.rejected = 1;
  EXPECT_THAT(Report(start_), HasSubstr("1 records rejected; the last one, of actor 0: reward is "
                                        "not finite"));
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

TEST_F(ProblemLogTest, TellsOfDropsGapsAndLosses) {
  counters_.after_gap = 3;
  counters_.lost = 4;
  const std::string lines = Report(start_, /*dropped_chunks=*/5);
  EXPECT_THAT(lines, HasSubstr("3 records not used"));
  EXPECT_THAT(lines, HasSubstr("4 records are lost"));
  EXPECT_THAT(lines, HasSubstr("5 chunks dropped"));
}

}  // namespace
}  // namespace shoal::replay
