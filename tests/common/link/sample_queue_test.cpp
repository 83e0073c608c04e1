// SPDX-License-Identifier: Apache-2.0
#include "common/link/sample_queue.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace shoal::link {
namespace {

using Numbers = std::vector<uint64_t>;

// Writes weights numbered `update`, whose key is `part`.
class Source {
 public:
  SharedSample Make(uint32_t part, uint64_t update) const {
    WeightsPart message;
    message.part = part;
    message.version.update = update;
    return std::make_shared<StoredMessage<WeightsPart>>(unread_, message);
  }

 private:
  const std::shared_ptr<Unread> unread_ = std::make_shared<Unread>();
};

uint64_t Update(const SharedSample& sample) {
  return sample == nullptr
             ? 0
             : static_cast<const StoredMessage<WeightsPart>&>(*sample).message().version.update;
}

Numbers PopAll(SampleQueue* queue) {
  Numbers updates;
  while (const SharedSample sample = queue->Pop()) updates.push_back(Update(sample));
  return updates;
}

TEST(SampleQueue, KeepsAllInOrder) {
  const Source source;
  SampleQueue queue(0);
  EXPECT_TRUE(queue.empty());
  for (uint64_t n = 1; n <= 5; ++n) EXPECT_EQ(queue.Push(source.Make(1, n)), nullptr);
  EXPECT_FALSE(queue.empty());
  EXPECT_EQ(PopAll(&queue), (Numbers{1, 2, 3, 4, 5}));
  EXPECT_TRUE(queue.empty());
}

TEST(SampleQueue, KeepsTheLastNOfEachKeyInTheOrderOfWriting) {
  const Source source;
  SampleQueue queue(2);
  Numbers pushed_out;
  for (const auto& [part, update] :
       std::vector<std::pair<uint32_t, uint64_t>>{{1, 1}, {2, 2}, {1, 3}, {1, 4}, {1, 5}, {2, 6}}) {
    pushed_out.push_back(Update(queue.Push(source.Make(part, update))));
  }
  EXPECT_EQ(pushed_out, (Numbers{0, 0, 0, 1, 3, 0}));
  EXPECT_EQ(PopAll(&queue), (Numbers{2, 4, 5, 6}));
}

TEST(SampleQueue, TakenSamplesDoNotCount) {
  const Source source;
  SampleQueue queue(1);
  queue.Push(source.Make(1, 1));
  EXPECT_EQ(Update(queue.Pop()), 1u);
  EXPECT_EQ(queue.Push(source.Make(1, 2)), nullptr);
  EXPECT_EQ(Update(queue.Push(source.Make(1, 3))), 2u);
  EXPECT_EQ(queue.TakeAll().size(), 1u);
  EXPECT_EQ(queue.Push(source.Make(1, 4)), nullptr);
  EXPECT_EQ(PopAll(&queue), Numbers{4});
}

TEST(SampleQueue, WritersDoNotPushEachOtherOut) {
  const Source first, second;
  SampleQueue queue(1);
  EXPECT_EQ(queue.Push(first.Make(1, 1)), nullptr);
  EXPECT_EQ(queue.Push(second.Make(1, 2)), nullptr);
  EXPECT_EQ(PopAll(&queue), (Numbers{1, 2}));
}

}  // namespace
}  // namespace shoal::link
