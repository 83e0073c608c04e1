// SPDX-License-Identifier: Apache-2.0
// Former names of configuration keys. Command lines, files, definitions of experiments and runs of
// earlier versions may use them.
#pragma once

#include <string>
#include <string_view>

namespace shoal {

// The present name of a key; `name` itself if it is no former name.
std::string_view PresentName(std::string_view name);

// If `name` is a former name, prints a line on stderr that gives the present one: once per name and
// process.
void NoteFormerName(std::string_view name);

}  // namespace shoal
