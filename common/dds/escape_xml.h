// Text as it may stand in XML. Internal to common/dds.
#pragma once

#include <string>
#include <string_view>

namespace shoal::dds {

std::string EscapeXml(std::string_view text);

}  // namespace shoal::dds
