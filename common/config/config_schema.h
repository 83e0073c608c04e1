// SPDX-License-Identifier: Apache-2.0
// The configuration as a JSON Schema (2020-12), for editors and for programs that write presets:
// types, ranges, choices, defaults and meanings, from the table that the parser walks.
//
// It says what can be said of one key at a time. Left to the parser: low <= high of an interval,
// the two ends of a schedule, and what several keys must agree on (Validate).
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace shoal {

// Of a preset, of a file for --config, and of a run's config.json.
nlohmann::ordered_json ConfigSchema();

}  // namespace shoal
