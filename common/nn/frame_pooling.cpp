#include "common/nn/frame_pooling.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "common/base/cpu_clones.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

constexpr int kLanes = 16;

float Rounded(float x, float) { return x; }

// To the nearest bf16, ties to even. The values are finite, so NaN needs no care.
uint16_t Rounded(float x, uint16_t) {
  const uint32_t bits = std::bit_cast<uint32_t>(x);
  return uint16_t((bits + 0x7fffu + ((bits >> 16) & 1u)) >> 16);
}

// Columns [j, j + n) of a row of 2x2 windows. A pair of neighbouring bytes is one 16-bit word,
// which keeps the loop free of shuffles.
template <class Out>
[[gnu::always_inline]] inline void PoolPairs(const uint8_t* upper, const uint8_t* lower, int n,
                                             float scale, Out* out) {
  for (int j = 0; j < n; ++j) {
    uint16_t a, b;
    std::memcpy(&a, upper + 2 * j, sizeof(a));
    std::memcpy(&b, lower + 2 * j, sizeof(b));
    const int sum = (a & 0xff) + (a >> 8) + (b & 0xff) + (b >> 8);
    out[j] = Rounded(float(sum) * scale - 0.5f, Out());
  }
}

// One plane with pool = 2. Whole blocks of lanes; the last one of a row overlaps its neighbour
// instead of leaving a remainder.
template <class Out>
[[gnu::always_inline]] inline void PoolPlaneByTwo(const uint8_t* in, int width, int rows,
                                                  int columns, float scale, Out* out) {
  for (int i = 0; i < rows; ++i) {
    const uint8_t* upper = in + int64_t(2 * i) * width;
    const uint8_t* lower = upper + width;
    Out* row = out + int64_t(i) * columns;
    if (columns < kLanes) {
      PoolPairs(upper, lower, columns, scale, row);
      continue;
    }
    for (int j = 0; j < columns; j += kLanes) {
      const int first = std::min(j, columns - kLanes);
      PoolPairs(upper + 2 * first, lower + 2 * first, kLanes, scale, row + first);
    }
  }
}

SHOAL_CPU_CLONES void PoolByTwo(const uint8_t* in, int width, int rows, int columns, float scale,
                                float* out) {
  PoolPlaneByTwo(in, width, rows, columns, scale, out);
}

SHOAL_CPU_CLONES void PoolByTwo(const uint8_t* in, int width, int rows, int columns, float scale,
                                uint16_t* out) {
  PoolPlaneByTwo(in, width, rows, columns, scale, out);
}

template <class Out>
void PoolByAny(const uint8_t* in, int width, int rows, int columns, int pool, float scale,
               Out* out) {
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const uint8_t* window = in + (int64_t(i) * width + j) * pool;
      int sum = 0;
      for (int y = 0; y < pool; ++y) {
        for (int x = 0; x < pool; ++x) sum += window[y * width + x];
      }
      out[int64_t(i) * columns + j] = Rounded(float(sum) * scale - 0.5f, Out());
    }
  }
}

template <class Out>
void PoolPlanes(const uint8_t* in, const FrameShape& shape, int pool, Out* out) {
  const int rows = shape.height / pool, columns = shape.width / pool;
  const float scale = float(1.0 / (255.0 * pool * pool));
  ParallelFor(shape.planes, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      const uint8_t* plane = in + int64_t(p) * shape.height * shape.width;
      Out* pooled = out + int64_t(p) * rows * columns;
      if (pool == 2) {
        PoolByTwo(plane, shape.width, rows, columns, scale, pooled);
      } else {
        PoolByAny(plane, shape.width, rows, columns, pool, scale, pooled);
      }
    }
  });
}

struct Moments {
  uint64_t sum = 0, squares = 0;
};

// Sums of up to 32,768 bytes fit 31 bits (32,768 * 255^2 < 2^31); signed 16-bit factors are what
// the multiply-and-add instructions take.
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
  constexpr int kBlock = 32'768;
  Moments total;
  for (int begin = 0; begin < bytes; begin += kBlock) {
    const Moments block = MomentsOf(in + begin, std::min(kBlock, bytes - begin));
    total.sum += block.sum;
    total.squares += block.squares;
  }
  const double mean = double(total.sum) / bytes;
  return std::sqrt(std::max(0.0, double(total.squares) / bytes - mean * mean));
}

}  // namespace

void PoolFrames(const uint8_t* in, const FrameShape& shape, int pool, float* out) {
  PoolPlanes(in, shape, pool, out);
}

void PoolFramesToBf16(const uint8_t* in, const FrameShape& shape, int pool, uint16_t* out) {
  PoolPlanes(in, shape, pool, out);
}

double MeanFrameSpread(const uint8_t* in, int images, int bytes) {
  std::vector<double> spreads(static_cast<size_t>(images));
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
