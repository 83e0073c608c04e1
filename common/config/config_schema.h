// SPDX-License-Identifier: Apache-2.0
// The configuration as a JSON Schema (2020-12), for editors and for programs that write presets.
// The schema contains types, ranges, choices, defaults and meanings. It is made from the table that
// the parser uses.
//
// The schema contains only rules of single keys. The following rules are checked only by the
// parser: low <= high of an interval, the range of a schedule's start and end, and rules that
// involve several keys (Validate).
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace shoal {

// JSON Schema of a preset, of a file for --config, and of a run's config.json.
nlohmann::ordered_json ConfigSchema();

}  // namespace shoal
