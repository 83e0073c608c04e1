// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/frame_packing.h"

#include <cstddef>

#include "common/base/check.h"
#include "common/base/cpu_clones.h"

namespace shoal::worlds {
namespace {

SHOAL_CPU_CLONES void SplitRow(const uint8_t* from, size_t width, uint8_t* red, uint8_t* green,
                               uint8_t* blue) {
  for (size_t x = 0; x < width; ++x) {
    red[x] = from[3 * x];
    green[x] = from[3 * x + 1];
    blue[x] = from[3 * x + 2];
  }
}

SHOAL_CPU_CLONES void LumaRow(const uint8_t* from, size_t width, uint8_t* luma) {
  for (size_t x = 0; x < width; ++x) {
    const int sum = 77 * from[3 * x] + 150 * from[3 * x + 1] + 29 * from[3 * x + 2];
    luma[x] = static_cast<uint8_t>((sum + 128) >> 8);
  }
}

SHOAL_CPU_CLONES void LumaOfPlanes(const uint8_t* red, const uint8_t* green, const uint8_t* blue,
                                   size_t count, uint8_t* luma) {
  for (size_t i = 0; i < count; ++i) {
    luma[i] = static_cast<uint8_t>((77 * red[i] + 150 * green[i] + 29 * blue[i] + 128) >> 8);
  }
}

void CheckSizes(std::span<const uint8_t> pixels, size_t plane, std::span<uint8_t> planes,
                size_t channels) {
  CHECK(pixels.size() == 3 * plane) << pixels.size() << " bytes for " << plane << " pixels";
  CHECK(planes.size() == channels * plane) << planes.size() << " bytes for " << plane << " pixels";
}

}  // namespace

void PackRgb(std::span<const uint8_t> pixels, int height, int width, std::span<uint8_t> planes) {
  const auto rows = static_cast<size_t>(height), columns = static_cast<size_t>(width);
  const size_t plane = rows * columns;
  CheckSizes(pixels, plane, planes, 3);
  for (size_t y = 0; y < rows; ++y) {
    uint8_t* to = planes.data() + y * columns;
    SplitRow(pixels.data() + (rows - 1 - y) * columns * 3, columns, to, to + plane, to + 2 * plane);
  }
}

void PackGrey(std::span<const uint8_t> pixels, int height, int width, std::span<uint8_t> plane) {
  const auto rows = static_cast<size_t>(height), columns = static_cast<size_t>(width);
  CheckSizes(pixels, rows * columns, plane, 1);
  for (size_t y = 0; y < rows; ++y) {
    LumaRow(pixels.data() + (rows - 1 - y) * columns * 3, columns, plane.data() + y * columns);
  }
}

void GreyOfPlanes(std::span<const uint8_t> planes, std::span<uint8_t> plane) {
  const size_t count = plane.size();
  CHECK(planes.size() == 3 * count) << planes.size() << " bytes for " << count << " pixels";
  LumaOfPlanes(planes.data(), planes.data() + count, planes.data() + 2 * count, count,
               plane.data());
}

}  // namespace shoal::worlds
