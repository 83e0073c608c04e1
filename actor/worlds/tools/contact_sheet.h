// SPDX-License-Identifier: Apache-2.0
// Contact sheet: one labelled picture that shows every task from every camera in both qualities.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "actor/worlds/tools/render_task.h"

namespace shoal::worlds {

struct ContactSheetRequest {
  int side = 136;  // of one square picture, pixels
  int64_t seed = 1;
};

// One picture of the sheet, before it is drawn.
struct ContactSheetTile {
  std::vector<std::string> tasks;  // tasks with the same physics half, which look alike
  std::string camera, quality;
};

using ContactSheetRows = std::vector<std::vector<ContactSheetTile>>;

// Plans the tiles of all tasks: one row per physics half, in the order of registration. A row has
// two tiles for each camera: quality fast, then reference.
ContactSheetRows PlanContactSheet();

// Draws the sheet. Throws Error (kUsage) if the side is not 16..1024.
Picture DrawContactSheet(const ContactSheetRows& rows, const ContactSheetRequest& request);

}  // namespace shoal::worlds
