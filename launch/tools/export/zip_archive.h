// SPDX-License-Identifier: Apache-2.0
// Zip archives of uncompressed files.
//
// Source: PKWARE's APPNOTE.TXT 6.3, sections 4.3.7 (local header), 4.3.12 (central directory),
// 4.3.16 (end of the central directory).
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace shoal::launch {

// `files`: (name, content), in the order of the archive. All times are 1980-01-01, so that equal
// files give equal bytes. Throws Error if the archive reaches 2 GB.
std::string WriteZip(const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace shoal::launch
