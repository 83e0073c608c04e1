// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/contact_sheet.h"

#include <algorithm>
#include <array>

#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "common/image/text.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

constexpr int kSmallestSide = 16, kLargestSide = 1024;
constexpr int kGap = 4;  // pixels around tiles
constexpr std::array<uint8_t, 3> kPaper{255, 255, 255}, kInk{0, 0, 0};

// Names of the physics halves with the tasks that use each, in the order of registration.
std::vector<std::pair<std::string, std::vector<std::string>>> TasksByWorld() {
  std::vector<std::pair<std::string, std::vector<std::string>>> worlds;
  for (const std::string& name : tasks::TaskNames()) {
    const std::string& world = tasks::FindTask(name).world();
    const auto found =
        std::ranges::find(worlds, world, [](const auto& entry) { return entry.first; });
    if (found == worlds.end()) {
      worlds.push_back({world, {name}});
    } else {
      found->second.push_back(name);
    }
  }
  return worlds;
}

// One line for each task, then one with camera and quality.
std::vector<std::string> Label(const ContactSheetTile& tile) {
  std::vector<std::string> lines = tile.tasks;
  lines.push_back(tile.camera + ", " + tile.quality);
  return lines;
}

struct Layout {
  int width = 0, height = 0;
  int cell_width = 0;             // one tile with its gap
  std::vector<int> label_height;  // per row
};

Layout LayOut(const ContactSheetRows& rows, int side) {
  Layout layout;
  size_t longest = 0, columns = 0;
  for (const auto& row : rows) {
    size_t lines = 0;
    columns = std::max(columns, row.size());
    for (const ContactSheetTile& tile : row) {
      const std::vector<std::string> label = Label(tile);
      lines = std::max(lines, label.size());
      for (const std::string& line : label) longest = std::max(longest, line.size());
    }
    layout.label_height.push_back(static_cast<int>(lines) * image::kCellHeight);
    layout.height += kGap + layout.label_height.back() + side;
  }
  layout.cell_width = std::max(side, static_cast<int>(longest) * image::kCellWidth) + kGap;
  layout.width = kGap + static_cast<int>(columns) * layout.cell_width;
  layout.height += kGap;
  return layout;
}

void Paste(const Picture& from, int x, int y, Picture* to) {
  const auto row_bytes = static_cast<size_t>(from.width) * 3;
  for (int row = 0; row < from.height; ++row) {
    const auto source = from.pixels.begin() + static_cast<std::ptrdiff_t>(row_bytes) * row;
    const auto target =
        static_cast<size_t>(y + row) * static_cast<size_t>(to->width) + static_cast<size_t>(x);
    std::copy_n(source, row_bytes, to->pixels.begin() + static_cast<std::ptrdiff_t>(3 * target));
  }
}

}  // namespace

ContactSheetRows PlanContactSheet() {
  ContactSheetRows rows;
  for (const auto& [name, tasks] : TasksByWorld()) {
    const auto world = MakeWorld(name, {});
    std::vector<ContactSheetTile> row;
    for (const CameraView& camera : world->cameras()) {
      for (const char* quality : {"fast", "native", "reference"})
        row.push_back({tasks, camera.name, quality});
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Picture DrawContactSheet(const ContactSheetRows& rows, const ContactSheetRequest& request) {
  if (request.side < kSmallestSide || request.side > kLargestSide) {
    throw UsageError("a contact sheet's pictures have {} pixels a side; expected {} to {}",
                     request.side, kSmallestSide, kLargestSide);
  }
  const Layout layout = LayOut(rows, request.side);
  Picture sheet{layout.width, layout.height, {}};
  sheet.pixels.assign(static_cast<size_t>(layout.width) * static_cast<size_t>(layout.height) * 3,
                      kPaper[0]);
  int y = kGap;
  for (size_t r = 0; r < rows.size(); ++r) {
    int x = kGap;
    for (const ContactSheetTile& tile : rows[r]) {
      int line_y = y;
      for (const std::string& line : Label(tile)) {
        image::DrawText(line, x, line_y, kInk, layout.width, layout.height, sheet.pixels);
        line_y += image::kCellHeight;
      }
      RenderRequest picture;
      picture.task = tile.tasks[0];
      picture.camera = tile.camera;
      picture.quality = tile.quality;
      picture.width = picture.height = request.side;
      picture.seed = request.seed;
      Paste(RenderTask(picture), x, y + layout.label_height[r], &sheet);
      x += layout.cell_width;
    }
    y += layout.label_height[r] + request.side + kGap;
  }
  return sheet;
}

}  // namespace shoal::worlds
