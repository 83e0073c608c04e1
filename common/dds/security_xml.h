// SPDX-License-Identifier: Apache-2.0
// The part of a DDS configuration that enables DDS Security. Internal to common/dds.
#pragma once

#include <filesystem>
#include <string>

#include "common/dds/bus.h"

namespace shoal::dds {

// The <Security> element for a role with the credentials in `folder` (common/credentials). Returns
// an empty string if `folder` is empty. Throws Error if the credentials are not valid or if
// Cyclone's security plugins are missing.
std::string SecurityElement(const std::filesystem::path& folder, Role role);

}  // namespace shoal::dds
