// SPDX-License-Identifier: Apache-2.0
#include "common/nn/frame_pooling.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "common/base/check.h"
#include "common/base/cpu_clones.h"
#include "common/nn/bf16.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

constexpr int kColumnsAtOnce = 16;
constexpr int kMaxPool = 257;  // 257 * 255 is the largest sum that 16 bits hold

struct Scaling {
  float factor, shift;
};

// Pools columns [j, j + n) of a row of 2x2 windows. A pair of neighbouring bytes is one 16-bit
// word, which keeps the loop free of shuffles.
template <class Out>
[[gnu::always_inline]] inline void PoolPairs(const uint8_t* upper, const uint8_t* lower, int n,
                                             Scaling scale, Out* out) {
  for (int j = 0; j < n; ++j) {
    uint16_t a, b;
    std::memcpy(&a, upper + 2 * j, sizeof(a));
    std::memcpy(&b, lower + 2 * j, sizeof(b));
    const int sum = (a & 0xff) + (a >> 8) + (b & 0xff) + (b >> 8);
    Store(float(sum) * scale.factor + scale.shift, out + j);
  }
}

// Pools one plane with pool = 2 in whole blocks of lanes. The last block of a row overlaps its
// neighbour, so there is no remainder.
template <class Out>
[[gnu::always_inline]] inline void PoolPlaneByTwo(const uint8_t* in, int width, int rows,
                                                  int columns, Scaling scale, Out* out) {
  for (int i = 0; i < rows; ++i) {
    const uint8_t* upper = in + int64_t(2 * i) * width;
    const uint8_t* lower = upper + width;
    Out* row = out + int64_t(i) * columns;
    if (columns < kColumnsAtOnce) {
      PoolPairs(upper, lower, columns, scale, row);
      continue;
    }
    for (int j = 0; j < columns; j += kColumnsAtOnce) {
      const int first = std::min(j, columns - kColumnsAtOnce);
      PoolPairs(upper + 2 * first, lower + 2 * first, kColumnsAtOnce, scale, row + first);
    }
  }
}

SHOAL_CPU_CLONES void PoolByTwo(const uint8_t* in, int width, int rows, int columns, Scaling scale,
                                float* out) {
  PoolPlaneByTwo(in, width, rows, columns, scale, out);
}

SHOAL_CPU_CLONES void PoolByTwo(const uint8_t* in, int width, int rows, int columns, Scaling scale,
                                uint16_t* out) {
  PoolPlaneByTwo(in, width, rows, columns, scale, out);
}

// One plane with pool = 1, which only scales.
template <class Out>
[[gnu::always_inline]] inline void ScalePixels(const uint8_t* in, int64_t n, Scaling scale,
                                               Out* out) {
  for (int64_t i = 0; i < n; ++i) Store(float(in[i]) * scale.factor + scale.shift, out + i);
}

SHOAL_CPU_CLONES void Scale(const uint8_t* __restrict in, int64_t n, Scaling scale,
                            float* __restrict out) {
  ScalePixels(in, n, scale, out);
}

SHOAL_CPU_CLONES void Scale(const uint8_t* __restrict in, int64_t n, Scaling scale,
                            uint16_t* __restrict out) {
  ScalePixels(in, n, scale, out);
}

// sums[j] = sum of column j over `rows` rows of `width` bytes. A pixel is at most 255 and there are
// at most kMaxPool rows, so 16 bits hold the sum. This loop reads every pixel, without strides.
SHOAL_CPU_CLONES void SumRows(const uint8_t* __restrict in, int rows, int width,
                              uint16_t* __restrict sums) {
  for (int j = 0; j < width; ++j) sums[j] = in[j];
  for (int y = 1; y < rows; ++y) {
    const uint8_t* row = in + int64_t(y) * width;
    for (int j = 0; j < width; ++j) sums[j] = uint16_t(sums[j] + row[j]);
  }
}

template <class Out>
[[gnu::always_inline]] inline void PoolColumns(const uint16_t* sums, int columns, int pool,
                                               Scaling scale, Out* out) {
  for (int j = 0; j < columns; ++j) {
    int sum = 0;
    for (int x = 0; x < pool; ++x) sum += sums[j * pool + x];
    Store(float(sum) * scale.factor + scale.shift, out + j);
  }
}

// Writes one row of windows from the sums of its columns. If the compiler knows the pool, it reads
// the sums in vectors.
template <class Out>
[[gnu::always_inline]] inline void PoolRow(const uint16_t* sums, int columns, int pool,
                                           Scaling scale, Out* out) {
  switch (pool) {
    case 3:
      return PoolColumns(sums, columns, 3, scale, out);
    case 4:
      return PoolColumns(sums, columns, 4, scale, out);
    default:
      return PoolColumns(sums, columns, pool, scale, out);
  }
}

SHOAL_CPU_CLONES void PoolSums(const uint16_t* __restrict sums, int columns, int pool,
                               Scaling scale, float* __restrict out) {
  PoolRow(sums, columns, pool, scale, out);
}

SHOAL_CPU_CLONES void PoolSums(const uint16_t* __restrict sums, int columns, int pool,
                               Scaling scale, uint16_t* __restrict out) {
  PoolRow(sums, columns, pool, scale, out);
}

template <class Out>
void PoolByAny(const uint8_t* in, int width, int rows, int columns, int pool, Scaling scale,
               uint16_t* sums, Out* out) {
  for (int i = 0; i < rows; ++i) {
    SumRows(in + int64_t(i) * pool * width, pool, width, sums);
    PoolSums(sums, columns, pool, scale, out + int64_t(i) * columns);
  }
}

template <class Out>
void PoolPlanes(const uint8_t* in, const FrameShape& shape, int pool, float shift, Out* out) {
  const int rows = shape.height / pool, columns = shape.width / pool;
  const Scaling scale{float(1.0 / (255.0 * pool * pool)), shift};
  CHECK(pool >= 1 && pool <= kMaxPool) << "pool of " << pool;
  ParallelFor(shape.planes, [&](int begin, int end) {
    std::vector<uint16_t> sums(pool > 2 ? size_t(shape.width) : 0);
    for (int p = begin; p < end; ++p) {
      const uint8_t* plane = in + int64_t(p) * shape.height * shape.width;
      Out* pooled = out + int64_t(p) * rows * columns;
      if (pool == 1) {
        Scale(plane, int64_t(rows) * columns, scale, pooled);
      } else if (pool == 2) {
        PoolByTwo(plane, shape.width, rows, columns, scale, pooled);
      } else {
        PoolByAny(plane, shape.width, rows, columns, pool, scale, sums.data(), pooled);
      }
    }
  });
}

struct Moments {
  uint64_t sum = 0, squares = 0;
};

// Sums of up to 32,768 bytes fit 31 bits (32,768 * 255^2 < 2^31). The multiply-and-add instructions
// take signed 16-bit factors.
SHOAL_CPU_CLONES Moments MomentsOf(const uint8_t* in, int n) {
  int32_t sum = 0, squares = 0;
#pragma omp simd reduction(+ : sum, squares)
  for (int i = 0; i < n; ++i) {
    const int16_t value = in[i];
    sum += value;
    squares += value * value;
  }
  return {uint64_t(sum), uint64_t(squares)};
}

double StandardDeviation(const uint8_t* in, int bytes) {
  constexpr int kSummedTogether = 32'768;
  Moments total;
  for (int begin = 0; begin < bytes; begin += kSummedTogether) {
    const Moments block = MomentsOf(in + begin, std::min(kSummedTogether, bytes - begin));
    total.sum += block.sum;
    total.squares += block.squares;
  }
  const double mean = double(total.sum) / bytes;
  return std::sqrt(std::max(0.0, double(total.squares) / bytes - mean * mean));
}

}  // namespace

void PoolFrames(const uint8_t* in, const FrameShape& shape, int pool, float shift, float* out) {
  PoolPlanes(in, shape, pool, shift, out);
}

void PoolFramesToBf16(const uint8_t* in, const FrameShape& shape, int pool, float shift,
                      uint16_t* out) {
  PoolPlanes(in, shape, pool, shift, out);
}

double MeanFrameSpread(const uint8_t* in, int images, int bytes) {
  auto spreads = std::vector<double>(size_t(images));
  ParallelFor(images, [&](int begin, int end) {
    for (int b = begin; b < end; ++b) {
      spreads[size_t(b)] = StandardDeviation(in + int64_t(b) * bytes, bytes);
    }
  });
  double sum = 0;
  for (const double spread : spreads) sum += spread;
  return images > 0 ? sum / images : 0;
}

}  // namespace shoal::nn
