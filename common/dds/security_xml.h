// SPDX-License-Identifier: Apache-2.0
// The part of a DDS configuration that turns DDS Security on. Internal to common/dds.
#pragma once

#include <filesystem>
#include <string>

#include "common/dds/bus.h"

namespace shoal::dds {

// The <Security> element for a role with the credentials in `folder` (common/credentials); empty
// without a folder. Throws Error when they do not serve, or when Cyclone's plugins are not there.
std::string SecurityElement(const std::filesystem::path& folder, Role role);

}  // namespace shoal::dds
