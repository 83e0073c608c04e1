// SPDX-License-Identifier: Apache-2.0
// Checks links between the pages, and links from pages to files of the tree.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/docs/markdown.h"

namespace shoal {

// One line for each broken link: "docs/install.md:7: no 'own_tusk.md'", "...: own_task.md has no
// heading '#bild'". Links to other hosts are not followed.
std::vector<std::string> LinkFaults(const std::filesystem::path& root,
                                    const std::vector<Page>& pages);

}  // namespace shoal
