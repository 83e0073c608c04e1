// SPDX-License-Identifier: Apache-2.0
// Prioritised sampling in the source of batches: errors that requests bring.
#include <algorithm>
#include <vector>

#include "tests/learner/batch_source_fixture.h"

namespace shoal::learner {
namespace {

using std::chrono::milliseconds;

// Request r brings the errors of batch r - 5, because there are two credits.
TEST_F(BatchSourceTest, ARequestBringsTheErrorsOfABatchAFixedNumberBefore) {
  run_.config.replay.priorities = "proportional";
  BatchSource& source = Make();
  source.Next(Now());
  for (uint64_t request = 1; request <= 9; ++request) {
    Answer(request);
    ASSERT_TRUE(source.Next(Now()));
    source.TakeErrors(
        {.request = request, .ids = {10 * request}, .errors = {static_cast<float>(request)}});
  }
  ASSERT_EQ(requests_.size(), 11u);
  for (const SampleRequest& request : requests_) {
    if (request.request <= 5) {
      EXPECT_TRUE(request.error_ids.empty() && request.errors.empty()) << request.request;
      continue;
    }
    EXPECT_EQ(request.error_ids, std::vector<uint64_t>{10 * (request.request - 5)});
    EXPECT_EQ(request.errors, std::vector<float>{static_cast<float>(request.request - 5)});
  }
}

TEST_F(BatchSourceTest, ARepeatedRequestBringsTheSameErrors) {
  run_.config.replay.priorities = "proportional";
  BatchSource& source = Make(/*first_request=*/1, milliseconds(5));
  source.Next(Now());
  for (uint64_t request = 1; request <= 5; ++request) {
    Answer(request);
    ASSERT_TRUE(source.Next(Now()));
    source.TakeErrors({.request = request, .ids = {request}, .errors = {2}});
  }
  const SteadyTime deadline = Now() + kLong;
  while (std::ranges::count(Asked(), 7u) < 3 && Now() < deadline) source.Next(Now());
  EXPECT_GE(std::ranges::count(Asked(), 7u), 3);
  for (const SampleRequest& request : requests_) {
    if (request.request != 7) continue;
    EXPECT_EQ(request.error_ids, std::vector<uint64_t>{2});
  }
}

// A restarted replay has lost the priorities, so its answer may have other samples of the same
// ring.
TEST_F(BatchSourceTest, PartsFromBeforeARepeatedRequestAreNotMixedWithLaterOnes) {
  for (const bool prioritised : {false, true}) {
    run_.config.replay.priorities = prioritised ? "lap" : "none";
    const BatchSchema schema = BatchSchemaOf(run_);
    BatchSource& source = Make(1, milliseconds(300));
    source.Next(Now());
    const std::vector<uint8_t> bytes(schema.total_bytes());
    const auto answer = [&](uint32_t part) {
      const uint64_t half = schema.total_bytes() / 2;
      BatchPart message{.spec_hash = spec_hash_,
                        .learner_session = kLearnerSession,
                        .request = 1,
                        .part = part,
                        .parts = 2,
                        .offset = part * half,
                        .total_bytes = schema.total_bytes(),
                        .payload = {bytes.data(), part == 0 ? half : schema.total_bytes() - half}};
      source.OnPart(message);
    };
    answer(0);
    const auto repeated = [&] { return std::ranges::count(Asked(), 1u); };
    const auto before = repeated();
    while (repeated() == before) source.Next(Now() + milliseconds(5));
    answer(1);
    EXPECT_EQ(source.Next(Now()).has_value(), !prioritised);
    answer(0);
    EXPECT_EQ(source.Next(Now()).has_value(), prioritised);
  }
}

}  // namespace
}  // namespace shoal::learner
