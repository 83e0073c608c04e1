// SPDX-License-Identifier: Apache-2.0
// Converts JSON to a key's value. Internal to common/config.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "common/config/config_keys.h"

namespace shoal::internal {

// Sets the key's member. Returns false, and changes nothing, if the value has another type, does
// not fit the member or breaks the key's rule.
bool AssignValue(const Key& key, const nlohmann::json& value, Config* config);

}  // namespace shoal::internal
