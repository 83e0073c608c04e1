// SPDX-License-Identifier: Apache-2.0
// The MJCF files of models/, embedded in the program at build time.
#pragma once

#include <span>
#include <string_view>

namespace shoal::worlds {

struct ModelFile {
  std::string_view name;  // "fetch_reach.xml"
  std::string_view text;
};

// Defined in a source file that CMake generates.
std::span<const ModelFile> EmbeddedModelFiles();

}  // namespace shoal::worlds
