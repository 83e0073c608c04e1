// SPDX-License-Identifier: Apache-2.0
#include "common/nn/frame_pooling.h"

#include <gmock/gmock.h>

#include <cstring>

#include "common/nn/bf16.h"
#include "common/nn/parallel.h"
#include "tests/common/nn/gradient_check.h"

namespace shoal::nn {
namespace {

struct PoolingCase {
  FrameShape shape;
  int pool;
};

std::vector<uint8_t> RandomPixels(size_t n) {
  Random random(7);
  std::vector<uint8_t> frames(n);
  for (uint8_t& pixel : frames) pixel = uint8_t(random.Next());
  return frames;
}

reference::Values NaivePooling(const std::vector<uint8_t>& in, const FrameShape& s, int pool) {
  reference::Values out;
  for (int p = 0; p < s.planes; ++p) {
    for (int i = 0; i + pool <= s.height; i += pool) {
      for (int j = 0; j + pool <= s.width; j += pool) {
        double sum = 0;
        for (int u = 0; u < pool; ++u) {
          for (int v = 0; v < pool; ++v) {
            sum += in[size_t(p * s.height + i + u) * s.width + j + v];
          }
        }
        out.push_back(sum / (pool * pool) / 255 - 0.5);
      }
    }
  }
  return out;
}

class FramePoolingTest : public testing::TestWithParam<PoolingCase> {};

TEST_P(FramePoolingTest, AgreesWithTheNaiveMeanInBothTypes) {
  const auto& [shape, pool] = GetParam();
  const std::vector<uint8_t> in = RandomPixels(size_t(shape.planes) * shape.height * shape.width);
  const reference::Values exact = NaivePooling(in, shape, pool);
  std::vector<float> out(exact.size());
  PoolFrames(in.data(), shape, pool, -0.5f, out.data());
  for (size_t i = 0; i < exact.size(); ++i) ASSERT_NEAR(out[i], exact[i], 1e-6) << i;

  std::vector<uint16_t> out16(exact.size()), rounded(exact.size());
  PoolFramesToBf16(in.data(), shape, pool, -0.5f, out16.data());
  FloatsToBf16(out.data(), int64_t(out.size()), rounded.data());
  EXPECT_EQ(out16, rounded);
}

INSTANTIATE_TEST_SUITE_P(Shapes, FramePoolingTest,
                         testing::Values(PoolingCase{{3, 84, 84}, 2}, PoolingCase{{2, 9, 11}, 2},
                                         PoolingCase{{2, 33, 35}, 2}, PoolingCase{{1, 2, 2}, 2},
                                         PoolingCase{{3, 7, 5}, 1}, PoolingCase{{2, 84, 84}, 1},
                                         PoolingCase{{2, 10, 13}, 3}, PoolingCase{{2, 84, 85}, 3},
                                         PoolingCase{{2, 42, 83}, 4}, PoolingCase{{2, 35, 64}, 5},
                                         PoolingCase{{1, 33, 50}, 16}),
                         [](const auto& test) {
                           return std::to_string(test.param.shape.height) + "x" +
                                  std::to_string(test.param.shape.width) + "by" +
                                  std::to_string(test.param.pool);
                         });

TEST(FramePooling, BlackIsMinusAHalfAndWhiteAHalf) {
  std::vector<uint8_t> in(16, 0);
  std::memset(in.data() + 8, 255, 8);
  std::vector<float> out(4);
  PoolFrames(in.data(), {1, 4, 4}, 2, -0.5f, out.data());
  EXPECT_THAT(out,
              testing::Pointwise(testing::FloatEq(), std::vector<float>{-0.5f, -0.5f, 0.5f, 0.5f}));
}

TEST(FramePooling, WithoutAShiftBlackIsZeroAndWhiteOne) {
  for (const int pool : {1, 2, 3}) {
    const std::vector<uint8_t> in{0,   0,   0,   0,   0,   0,   0,   0,   0,
                                  255, 255, 255, 255, 255, 255, 255, 255, 255};
    std::vector<float> out(size_t(2 * (3 / pool) * (3 / pool)));
    PoolFrames(in.data(), {2, 3, 3}, pool, 0.f, out.data());
    EXPECT_FLOAT_EQ(out.front(), 0.f) << pool;
    EXPECT_FLOAT_EQ(out.back(), 1.f) << pool;
  }
}

TEST(FramePooling, IsTheSameForAnyNumberOfThreads) {
  const std::vector<uint8_t> in = RandomPixels(5 * 84 * 84);
  std::vector<float> one(5 * 42 * 42), three(one.size());
  {
    const ThreadScope scope(1);
    PoolFrames(in.data(), {5, 84, 84}, 2, -0.5f, one.data());
  }
  const ThreadScope scope(3);
  PoolFrames(in.data(), {5, 84, 84}, 2, -0.5f, three.data());
  EXPECT_EQ(one, three);
}

TEST(FrameSpread, IsTheMeanOfTheFramesStandardDeviations) {
  // Deviations 0 and 50 grey levels.
  const std::vector<uint8_t> frames{7, 7, 7, 7, 0, 100, 100, 0};
  EXPECT_DOUBLE_EQ(MeanFrameSpread(frames.data(), 2, 4), 25);
}

TEST(FrameSpread, DoesNotOverflowOnLargeBrightFrames) {
  std::vector<uint8_t> frame(200'000, 255);
  EXPECT_DOUBLE_EQ(MeanFrameSpread(frame.data(), 1, int(frame.size())), 0);
  for (size_t i = 0; i < frame.size(); i += 2) frame[i] = 253;
  EXPECT_NEAR(MeanFrameSpread(frame.data(), 1, int(frame.size())), 1, 1e-6);
}

}  // namespace
}  // namespace shoal::nn
