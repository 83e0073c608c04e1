// SPDX-License-Identifier: Apache-2.0
#include "common/link/stored_sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "tests/common/link/example_messages.h"
#include "tests/common/link/message_text.h"

namespace shoal::link {
namespace {

TEST(StoredMessage, HasEveryFieldAndAPayloadOfItsOwn) {
  std::vector<uint8_t> payload = ExamplePayload(7, 1001);
  WithExample<TransitionChunk>(7, payload, [&](const TransitionChunk& chunk) {
    const StoredMessage<TransitionChunk> stored(std::make_shared<Unread>(), chunk);
    const std::string written = Describe(chunk);
    std::ranges::fill(payload, uint8_t{0});
    EXPECT_EQ(Describe(stored.message()), written);
    EXPECT_NE(stored.message().payload.data(), payload.data());
  });
}

TEST(StoredMessage, AlignsPayloadsTo8) {
  const std::vector<uint8_t> payload(100);
  // Several at once, so that they do not get the same place.
  std::vector<std::unique_ptr<StoredMessage<BatchPart>>> stored;
  for (size_t bytes = 1; bytes < payload.size(); ++bytes) {
    BatchPart part;
    part.payload = {payload.data() + 1, bytes};
    stored.push_back(std::make_unique<StoredMessage<BatchPart>>(std::make_shared<Unread>(), part));
    EXPECT_EQ(reinterpret_cast<uintptr_t>(stored.back()->message().payload.data()) % 8, 0u);
  }
}

TEST(StoredMessage, CountsItsPayload) {
  const std::vector<uint8_t> payload(1000);
  TransitionChunk chunk;
  chunk.payload = payload;
  const StoredMessage<TransitionChunk> stored(std::make_shared<Unread>(), chunk);
  EXPECT_EQ(stored.bytes(), sizeof(TransitionChunk) + 1000);
  EXPECT_EQ(StoredMessage<TransitionChunk>::Bytes(chunk), stored.bytes());
  EXPECT_EQ(StoredMessage<SampleRequest>::Bytes(SampleRequest()), sizeof(SampleRequest));
}

TEST(StoredMessage, TakesAnEmptyPayload) {
  const StoredMessage<TransitionChunk> stored(std::make_shared<Unread>(), TransitionChunk());
  EXPECT_TRUE(stored.message().payload.empty());
}

}  // namespace
}  // namespace shoal::link
