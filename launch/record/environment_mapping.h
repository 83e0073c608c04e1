// SPDX-License-Identifier: Apache-2.0
// The mapping of a user's environment to a run's frames, blocks and actions, for `shoal env
// describe`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/config/run_config.h"
#include "common/tasks/environment_description.h"

namespace shoal::launch {

// "[-8, 8]": from the lowest to the highest bound of the elements.
std::string BoundsText(const tasks::ArraySpace& space);

// Text for people; each line has its newline. Both functions CHECK that the run's spec has an
// environment.
std::string DescribeMapping(const RunConfig& run);
// The same for programs, schema shoal-env-mapping-1.
nlohmann::ordered_json MappingJson(const RunConfig& run);

}  // namespace shoal::launch
