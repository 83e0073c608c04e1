// SPDX-License-Identifier: Apache-2.0
// The configuration as a JSON Schema (2020-12), for editors and for programs that write presets:
// types, ranges, choices, defaults and meanings, from the table that the parser uses.
//
// The schema has the rules of single keys. The parser alone checks low <= high of an interval, the
// two ends of a schedule, and rules across keys (Validate).
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace shoal {

// JSON Schema of a preset, of a file for --config, and of a run's config.json.
nlohmann::ordered_json ConfigSchema();

}  // namespace shoal
