// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/batches_in_work.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace shoal::replay {
namespace {

class BatchesInWorkTest : public testing::Test {
 protected:
  // A batch whose frame is a copy of frame_, from a record with this id; 0 = without a frame.
  BegunBatch Batch(uint64_t request, uint64_t oldest) {
    BegunBatch batch{.batch = {.request = {.request = request}, .stored_records = 10 * request},
                     .copies = {.copies = {}, .channels = 1, .height = 3, .width = 4}};
    batch.copies.oldest = oldest;
    if (oldest != 0) batch.copies.copies.push_back({frame_.data(), {}, out_.at(request).data()});
    return batch;
  }
  std::vector<uint64_t> Complete() {
    std::vector<uint64_t> requests;
    for (const DrawnBatch& batch : in_work_.TakeComplete()) {
      requests.push_back(batch.request.request);
      EXPECT_EQ(batch.stored_records, 10 * batch.request.request);
    }
    return requests;
  }
  bool Copied(uint64_t request) const { return out_.at(request) == frame_; }

  using Requests = std::vector<uint64_t>;
  const std::vector<uint8_t> frame_{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  std::vector<std::vector<uint8_t>> out_ =
      std::vector<std::vector<uint8_t>>(5, std::vector<uint8_t>(12));
  GatherThreads threads_;
  BatchesInWork in_work_{&threads_};
};

TEST_F(BatchesInWorkTest, ABatchIsCompleteWhenItsFramesAreCopied) {
  in_work_.Add(Batch(1, 7));
  in_work_.Add(Batch(2, 8));
  EXPECT_TRUE(in_work_.Has(1) && in_work_.Has(2));
  EXPECT_FALSE(in_work_.Has(3));
  EXPECT_EQ(Complete(), Requests());
  EXPECT_TRUE(threads_.Help());
  EXPECT_TRUE(Copied(1));
  EXPECT_FALSE(Copied(2));
  EXPECT_EQ(Complete(), Requests({1}));
  EXPECT_FALSE(in_work_.Has(1));
  in_work_.Finish();
  EXPECT_TRUE(Copied(2));
  EXPECT_FALSE(in_work_.empty()) << "the complete batch was not taken yet";
  EXPECT_EQ(Complete(), Requests({2}));
  EXPECT_TRUE(in_work_.empty());
}

TEST_F(BatchesInWorkTest, ABatchWithoutFramesIsCompleteAtOnce) {
  in_work_.Add(Batch(1, 7));
  in_work_.Add(Batch(2, 0));
  EXPECT_EQ(Complete(), Requests({2}));
  EXPECT_TRUE(in_work_.Has(1));
}

TEST_F(BatchesInWorkTest, ReadersOfRecordsThatWillBeOverwrittenAreCompleted) {
  in_work_.Add(Batch(1, 20));
  in_work_.Add(Batch(2, 0));
  in_work_.FinishReadersUpTo(19);
  EXPECT_FALSE(Copied(1)) << "it copies no record up to 19";
  in_work_.FinishReadersUpTo(20);
  EXPECT_TRUE(Copied(1));
  in_work_.Add(Batch(3, 30));
  in_work_.Add(Batch(4, 25));
  in_work_.FinishReadersUpTo(26);
  EXPECT_TRUE(Copied(4)) << "though an older batch copies only newer records";
  EXPECT_EQ(Complete(), Requests({1, 2, 3, 4}));
}

TEST_F(BatchesInWorkTest, HelpersCompleteBatchesAlone) {
  threads_.Resize(3);
  in_work_.Add(Batch(1, 7));
  in_work_.Add(Batch(2, 8));
  for (Requests complete; complete.size() < 2; std::this_thread::yield()) {
    for (const uint64_t request : Complete()) complete.push_back(request);
  }
  EXPECT_TRUE(Copied(1) && Copied(2));
}

}  // namespace
}  // namespace shoal::replay
