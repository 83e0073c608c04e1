// SPDX-License-Identifier: Apache-2.0
// Compares the kernels of inputs with the operations of the CPU.
#include "learner/device/kernels/inputs.h"

#include <gmock/gmock.h>

#include "common/nn/bf16.h"
#include "common/nn/frame_pooling.h"
#include "learner/engine/columns.h"
#include "tests/learner/device/kernels/kernel_fixture.h"

namespace shoal::learner::kernels {
namespace {

class InputKernels : public KernelTest {
 protected:
  // Frames (2, 5, height, width), pooled on the CPU and with channels last, padded to 8.
  void ComparePool(int height, int width, int pool) {
    constexpr int kBatch = 2, kChannels = 5, kPadded = 8;
    std::vector<uint8_t> frames;
    for (const float x : Random(size_t(kBatch * kChannels) * height * width, 0, 255.9)) {
      frames.push_back(uint8_t(x));
    }
    const int rows = height / pool, columns = width / pool;
    std::vector<float> planes(size_t(kBatch * kChannels * rows * columns));
    nn::PoolFrames(frames.data(), {kBatch * kChannels, height, width}, pool, -0.5f, planes.data());
    std::vector<float> expected;
    for (int b = 0; b < kBatch; ++b) {
      for (int pixel = 0; pixel < rows * columns; ++pixel) {
        for (int c = 0; c < kPadded; ++c) {
          const int at = (b * kChannels + c) * rows * columns + pixel;
          expected.push_back(c < kChannels ? planes[size_t(at)] : 0.f);
        }
      }
    }
    float* f32 = Out(expected.size());
    auto* bf16 = Out<uint16_t>(expected.size());
    auto* alone = Out<uint16_t>(expected.size());
    PoolFrames kernel{.in = In(frames),
                      .out = {f32, bf16},
                      .batch = kBatch,
                      .channels = kChannels,
                      .height = height,
                      .width = width,
                      .pool = pool,
                      .out_channels = kPadded,
                      .factor = float(1.0 / (255.0 * pool * pool)),
                      .shift = -0.5f};
    Run(kernel);
    kernel.out = {nullptr, alone};
    Run(kernel);
    ExpectClose(f32, expected, 1e-6);
    std::vector<uint16_t> rounded(expected.size());
    nn::FloatsToBf16(f32, int64_t(rounded.size()), rounded.data());
    EXPECT_EQ(std::vector<uint16_t>(bf16, bf16 + rounded.size()), rounded);
    EXPECT_EQ(std::vector<uint16_t>(alone, alone + rounded.size()), rounded);
  }
};

TEST_F(InputKernels, FramesArePooledAndScaled) {
  ComparePool(9, 7, 1);
  ComparePool(17, 31, 2);
  ComparePool(20, 11, 3);
  ComparePool(64, 65, 1);  // several blocks
  ComparePool(50, 64, 1);  // four pixels for each thread, several blocks
  ComparePool(42, 84, 2);  // two pixels for each thread
  ComparePool(12, 84, 3);
}

TEST_F(InputKernels, ColumnsAreJoinedAndSplit) {
  constexpr int kRows = 37;
  const std::vector<float> left = Random(kRows * 3), right = Random(kRows * 10);
  const std::vector<ObservationSpec::Range> ranges{{1, 4}, {7, 2}};
  std::vector<float> joined(kRows * 9);
  learner::JoinColumns(kRows, left, right, ranges, joined);
  float* out = Out(joined.size());
  auto* rounded = Out<uint16_t>(joined.size());
  CopyColumns join{.rows = kRows};
  join.Add({In(left), 3, 0, 3, {out, rounded}, 9, 0});
  const float* from = In(right);
  join.Add({from, 10, 1, 4, {out, rounded}, 9, 3});
  join.Add({from, 10, 7, 2, {out, rounded}, 9, 7});
  Run(join);
  ExpectClose(out, joined, 0);
  ExpectClose(FromBf16s(rounded, joined.size()).data(), joined, 0.005);

  float *first = Out(kRows * 2), *second = In(right);
  CopyColumns split{.rows = kRows};
  split.Add({out, 9, 5, 2, {first, nullptr}, 2, 0});
  split.Add({out, 9, 0, 5, {second, nullptr}, 10, 5, /*adds=*/true});
  Run(split);
  for (int b = 0; b < kRows; ++b) {
    EXPECT_EQ(first[b * 2 + 1], joined[size_t(b * 9 + 6)]);
    EXPECT_EQ(second[b * 10 + 4], right[size_t(b * 10 + 4)]);
    EXPECT_EQ(second[b * 10 + 9], right[size_t(b * 10 + 9)] + joined[size_t(b * 9 + 4)]);
  }
}

TEST_F(InputKernels, ColumnsOfFunctionsAreSummed) {
  constexpr int kFunctions = 3, kRows = 33, kWidth = 7;
  const std::vector<float> from = Random(kFunctions * kRows * kWidth), more = Random(kRows * 2);
  float* out = Out(kRows * 2);
  Run(SumColumns{.functions = kFunctions,
                 .rows = kRows,
                 .columns = 2,
                 .from = In(from),
                 .from_width = kWidth,
                 .first = 4,
                 .addend = In(more),
                 .to = {out, nullptr}});
  std::vector<float> expected = more;
  for (size_t i = 0; i < expected.size(); ++i) {
    for (size_t f = 0; f < kFunctions; ++f) {
      expected[i] += from[(f * kRows + i / 2) * kWidth + 4 + i % 2];
    }
  }
  ExpectClose(out, expected, 1e-6);
}

TEST_F(InputKernels, LabelsAreGathered) {
  constexpr int kRows = 29;
  const std::vector<float> observed = Random(kRows * 4), privileged = Random(kRows * 6);
  const std::vector<LabelColumns> columns{{{true, 3}, {}}, {{false, 5}, {{true, 0}}}};
  std::vector<float> expected(kRows * 2);
  learner::GatherLabels(kRows, observed, privileged, columns, 0.3f, expected);
  GatherLabels gather{.rows = kRows, .label_count = 2, .unit = 0.3f};
  const float *seen = In(observed), *hidden = In(privileged);
  gather.columns[0] = {{seen, 4, 3}, {}};
  gather.columns[1] = {{hidden, 6, 5}, {seen, 4, 0}};
  gather.labels = Out(expected.size());
  Run(gather);
  ExpectClose(gather.labels, expected, 0);
}

}  // namespace
}  // namespace shoal::learner::kernels
