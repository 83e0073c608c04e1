// SPDX-License-Identifier: Apache-2.0
// Escapes text for XML and HTML, in elements and in quoted attributes.
#pragma once

#include <string>
#include <string_view>

namespace shoal {

std::string EscapeMarkup(std::string_view text);

}  // namespace shoal
