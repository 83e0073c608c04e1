// SPDX-License-Identifier: Apache-2.0
#include "common/intake/intake_problems.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/log.h"

namespace shoal {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class IntakeProblemsTest : public testing::Test {
 protected:
  IntakeProblemsTest() { log::Start("test", ""); }

  void Take(const TransitionChunk& chunk, const ChunkResult& result) {
    counters_.Count(result);
    problems_.Note(chunk, result);
  }
  std::string Report(SteadyTime now, uint64_t dropped_chunks = 0) {
    testing::internal::CaptureStderr();
    problems_.Report(now, counters_, dropped_chunks);
    return testing::internal::GetCapturedStderr();
  }

  const SteadyTime start_ = Now();
  IntakeCounters counters_;
  IntakeProblems problems_{0xabc, "replay server"};
};

TEST_F(IntakeProblemsTest, IsSilentWithoutProblems) {
  Take({}, {.stored = 3, .duplicates = 2});
  Take({}, {.fate = ChunkFate::kAhead});
  Take({}, {.fate = ChunkFate::kSuperseded});
  EXPECT_THAT(Report(start_), IsEmpty());
  EXPECT_THAT(Report(start_ + IntakeProblems::kInterval), IsEmpty());
}

TEST_F(IntakeProblemsTest, NamesBothSpecsOncePerInterval) {
  TransitionChunk chunk;
  chunk.actor = 4;
  chunk.spec_hash = 0xdef;
  for (int i = 0; i < 2; ++i) Take(chunk, {.fate = ChunkFate::kWrongSpec});
  EXPECT_THAT(Report(start_), HasSubstr("2 chunks refused: actor 4 has observation spec "
                                        "0000000000000def, the run has 0000000000000abc"));
  for (int i = 0; i < 3; ++i) Take(chunk, {.fate = ChunkFate::kWrongSpec});
  EXPECT_THAT(Report(start_ + IntakeProblems::kInterval / 2), IsEmpty());
  EXPECT_THAT(Report(start_ + IntakeProblems::kInterval), HasSubstr("3 chunks refused"));
}

TEST_F(IntakeProblemsTest, NamesTheActorWhoseClockIsAhead) {
  TransitionChunk chunk;
  chunk.actor = 7;
  chunk.session = static_cast<uint64_t>(WallTimeNs()) + 3'600'000'000'000;
  Take(chunk, {.fate = ChunkFate::kFuture});
  EXPECT_THAT(Report(start_),
              HasSubstr("1 chunks refused: actor 7 says that its session begins at 3600 s"));
}

TEST_F(IntakeProblemsTest, NamesTheFaultOfRejectedRecords) {
  Take({}, {.rejected = 1, .fault = "reward is not finite"});
  EXPECT_THAT(Report(start_), HasSubstr("1 records rejected; the last one, of actor 0: reward is "
                                        "not finite"));
}

TEST_F(IntakeProblemsTest, TellsOfDropsGapsLossesAndWhatMakesNoSense) {
  Take({}, {.after_gap = 3, .lost = 4});
  Take({}, {.fate = ChunkFate::kMalformed});
  const std::string lines = Report(start_, /*dropped_chunks=*/5);
  EXPECT_THAT(lines, HasSubstr("3 records not used"));
  EXPECT_THAT(lines,
              HasSubstr("4 records are lost: they were in the memory of an earlier replay server"));
  EXPECT_THAT(lines, HasSubstr("1 chunks refused: their length"));
  EXPECT_THAT(lines, HasSubstr("5 chunks dropped"));
}

TEST(IntakeCounters, RefusedAreThoseOfWhichNothingIsTaken) {
  IntakeCounters counters;
  for (const ChunkFate fate :
       {ChunkFate::kDealtWith, ChunkFate::kAhead, ChunkFate::kSuperseded, ChunkFate::kFuture,
        ChunkFate::kWrongSpec, ChunkFate::kMalformed, ChunkFate::kTableFull}) {
    counters.Count({.fate = fate});
  }
  EXPECT_EQ(counters.refused_chunks(), 5u);
}

}  // namespace
}  // namespace shoal
