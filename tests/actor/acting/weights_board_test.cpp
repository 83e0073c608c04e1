// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/weights_board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <memory>
#include <string>

#include "tests/support/error_message.h"

namespace shoal::actor {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr uint64_t kBoardSpec = 5;

ReceivedWeights Weights(uint64_t update, std::string payload) {
  return {.version = {7, update}, .env_steps = 10 * update, .checkpoint = {}, .payload = payload};
}

TEST(WeightsBoard, ANeighbourReadsTheNewestOnce) {
  WeightsBoard board(kBoardSpec);
  WeightsBoardReader reader(board.address(), kBoardSpec);
  EXPECT_FALSE(reader.TryTake());
  board.Post(Weights(1, "a"));
  board.Post(Weights(2, "bc"));
  const auto weights = reader.TryTake();
  ASSERT_TRUE(weights);
  EXPECT_EQ(weights->version, (WeightsVersion{7, 2}));
  EXPECT_EQ(weights->env_steps, 20u);
  EXPECT_EQ(weights->payload.view(), "bc");
  EXPECT_FALSE(reader.TryTake());
}

TEST(WeightsBoard, EachNeighbourReadsForItself) {
  WeightsBoard board(kBoardSpec);
  board.Post(Weights(1, "a"));
  WeightsBoardReader early(board.address(), kBoardSpec);
  EXPECT_EQ(early.TryTake()->payload.view(), "a");
  board.Post(Weights(2, std::string(3'000'000, 'x')));
  WeightsBoardReader late(board.address(), kBoardSpec);
  EXPECT_EQ(early.TryTake()->payload.view(), std::string(3'000'000, 'x'));
  EXPECT_EQ(late.TryTake()->payload.view(), std::string(3'000'000, 'x'));
}

TEST(WeightsBoard, OldVersionsLeaveTheMemory) {
  WeightsBoard board(kBoardSpec);
  WeightsBoardReader reader(board.address(), kBoardSpec);
  struct rlimit descriptors {};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &descriptors), 0);
  struct rlimit few = descriptors;
  few.rlim_cur = 64;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
  for (uint64_t update = 1; update <= 200; ++update) {
    board.Post(Weights(update, "payload"));
    if (update % 3 != 0) continue;
    const auto weights = reader.TryTake();
    ASSERT_TRUE(weights);
    EXPECT_EQ(weights->version.update, update);
  }
  setrlimit(RLIMIT_NOFILE, &descriptors);
}

TEST(WeightsBoard, WithoutMemoryItIsClosedAndSaysSo) {
  WeightsBoard board(kBoardSpec);
  WeightsBoardReader reader(board.address(), kBoardSpec);
  struct rlimit before {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  struct rlimit small = before;
  small.rlim_cur = 8192;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_FALSE(reader.closed());
  const std::string message = ErrorMessage([&] { board.Post(Weights(1, std::string(9000, 'x'))); });
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_THAT(message, HasSubstr("ulimit -f"));
  EXPECT_TRUE(reader.closed());
  board.Post(Weights(2, "small"));
  EXPECT_FALSE(reader.TryTake());
}

TEST(WeightsBoard, WhatIsNoBoardOfTheRunIsRefused) {
  const WeightsBoard board(kBoardSpec);
  BoardAddress address = board.address();
  EXPECT_THAT(ErrorMessage([&] { WeightsBoardReader(address, kBoardSpec + 1); }),
              AllOf(HasSubstr("0000000000000005"), HasSubstr("0000000000000006")));
  address.token[1] ^= 1;
  EXPECT_THAT(ErrorMessage([&] { WeightsBoardReader(address, kBoardSpec); }),
              HasSubstr("no board"));
  const SharedMemory other = SharedMemory::Make("test", 4096);
  address.descriptor = other.descriptor();
  EXPECT_THAT(ErrorMessage([&] { WeightsBoardReader(address, kBoardSpec); }),
              HasSubstr("no board"));
  address.pid = 0x7fffffff;
  EXPECT_THAT(ErrorMessage([&] { WeightsBoardReader(address, kBoardSpec); }),
              HasSubstr("cannot open"));
}

TEST(WeightsBoard, AVersionThatWentWithItsProcessIsNotRead) {
  auto board = std::make_unique<WeightsBoard>(kBoardSpec);
  WeightsBoardReader reader(board->address(), kBoardSpec);
  board->Post(Weights(1, "a"));
  EXPECT_TRUE(reader.TryTake());
  EXPECT_FALSE(reader.failed());
  board->Post(Weights(2, "b"));
  board.reset();
  EXPECT_FALSE(reader.TryTake());
  EXPECT_TRUE(reader.failed());
}

}  // namespace
}  // namespace shoal::actor
