// SPDX-License-Identifier: Apache-2.0
#include "tests/support/paths.h"

namespace shoal {

std::string SourcePath(const std::string& file) { return SHOAL_SOURCE_DIR "/" + file; }

std::string GoldenPath(const std::string& file) { return SourcePath("tests/golden/" + file); }

std::string ProgramPath(const std::string& name) { return SHOAL_BIN "/" + name; }

}  // namespace shoal
