// SPDX-License-Identifier: Apache-2.0
// Every task as every camera sees it, in both qualities, in one picture with labels.
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
  std::vector<std::string> tasks;  // that look alike because they share their physics half
  std::string camera, quality;
};

using ContactSheetRows = std::vector<std::vector<ContactSheetTile>>;

// Everything there is: one row per physics half, in the order of registration; within a row the
// cameras, each in quality fast and then reference.
ContactSheetRows PlanContactSheet();

// Draws it. Throws Error (kUsage) on a side that is not 16..1024.
Picture DrawContactSheet(const ContactSheetRows& rows, const ContactSheetRequest& request);

}  // namespace shoal::worlds
