#include "common/nn/frame_pooling.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "common/base/cpu_clones.h"
#include "common/nn/bf16.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

// sums[j] = sum of the window j of `pool` rows that start at `in`.
SHOAL_CPU_CLONES void SumWindows(const uint8_t* in, int width, int pool, int columns, float* sums) {
  for (int j = 0; j < columns; ++j) {
    int sum = 0;
    for (int y = 0; y < pool; ++y) {
      for (int x = 0; x < pool; ++x) sum += in[y * width + j * pool + x];
    }
    sums[j] = float(sum);
  }
}

// The same for pool = 2: a pair of neighbouring bytes is one 16-bit word, which keeps the loop free
// of shuffles.
SHOAL_CPU_CLONES void SumPairs(const uint8_t* in, int width, int columns, float* sums) {
  const uint8_t* next = in + width;
  for (int j = 0; j < columns; ++j) {
    uint16_t upper, lower;
    std::memcpy(&upper, in + 2 * j, sizeof(upper));
    std::memcpy(&lower, next + 2 * j, sizeof(lower));
    sums[j] = float((upper & 0xff) + (upper >> 8) + (lower & 0xff) + (lower >> 8));
  }
}

SHOAL_CPU_CLONES void ScaleRow(const float* sums, int columns, float scale, float* out) {
  for (int j = 0; j < columns; ++j) out[j] = sums[j] * scale - 0.5f;
}

// Finite values only, so the rounding needs no care for NaN.
SHOAL_CPU_CLONES void ScaleRowToBf16(const float* sums, int columns, float scale, uint16_t* out) {
  for (int j = 0; j < columns; ++j) {
    const uint32_t bits = std::bit_cast<uint32_t>(sums[j] * scale - 0.5f);
    out[j] = uint16_t((bits + 0x7fffu + ((bits >> 16) & 1u)) >> 16);
  }
}

void Scale(const float* sums, int columns, float scale, float* out) {
  ScaleRow(sums, columns, scale, out);
}

void Scale(const float* sums, int columns, float scale, uint16_t* out) {
  ScaleRowToBf16(sums, columns, scale, out);
}

template <class Out>
void PoolPlanes(const uint8_t* in, const FrameShape& shape, int pool, Out* out) {
  const int rows = shape.height / pool, columns = shape.width / pool;
  const float scale = float(1.0 / (255.0 * pool * pool));
  ParallelFor(shape.planes, [&](int begin, int end) {
    std::vector<float> sums(static_cast<size_t>(columns));
    for (int p = begin; p < end; ++p) {
      const uint8_t* plane = in + int64_t(p) * shape.height * shape.width;
      for (int i = 0; i < rows; ++i) {
        const uint8_t* window_row = plane + int64_t(i) * pool * shape.width;
        if (pool == 2) {
          SumPairs(window_row, shape.width, columns, sums.data());
        } else {
          SumWindows(window_row, shape.width, pool, columns, sums.data());
        }
        Scale(sums.data(), columns, scale, out + (int64_t(p) * rows + i) * columns);
      }
    }
  });
}

struct Moments {
  uint64_t sum = 0, squares = 0;
};

// Sums of up to 65,536 bytes fit 32 bits (65,536 * 255^2 < 2^32).
SHOAL_CPU_CLONES Moments MomentsOf(const uint8_t* in, int n) {
  uint32_t sum = 0, squares = 0;
#pragma omp simd reduction(+ : sum, squares)
  for (int i = 0; i < n; ++i) {
    const uint32_t value = in[i];
    sum += value;
    squares += value * value;
  }
  return {sum, squares};
}

double StandardDeviation(const uint8_t* in, int bytes) {
  constexpr int kBlock = 65'536;
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
