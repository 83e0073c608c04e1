// SPDX-License-Identifier: Apache-2.0
// The mapping of a user's environment to a run's frames, blocks and actions, for `shoal env
// describe`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/config/run_config.h"
#include "common/tasks/environment_description.h"

namespace shoal::launch {

// "[-8, 8]": the lowest and the highest bound of all elements.
std::string BoundsText(const tasks::ArraySpace& space);

// The mapping as text for people; each line ends with a newline. CHECK: the run's spec has an
// environment.
std::string DescribeMapping(const RunConfig& run);
// The mapping as JSON for programs, schema shoal-env-mapping-1. CHECK: the run's spec has an
// environment.
nlohmann::ordered_json MappingJson(const RunConfig& run);

}  // namespace shoal::launch
