// SPDX-License-Identifier: Apache-2.0
// Text as it may stand in XML and HTML, in elements and in quoted attributes.
#pragma once

#include <string>
#include <string_view>

namespace shoal {

std::string EscapeMarkup(std::string_view text);

}  // namespace shoal
