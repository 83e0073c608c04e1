// SPDX-License-Identifier: Apache-2.0
// Former names of configuration keys. Command lines and files, for example definitions of
// experiments and runs of earlier versions, may use former names.
#pragma once

#include <string>
#include <string_view>

namespace shoal {

// The present name of a key. Returns `name` if it is not a former name.
std::string_view PresentName(std::string_view name);

// If `name` is a former name, prints a line on stderr that gives the present name. A process prints
// this line only once for each name.
void NoteFormerName(std::string_view name);

}  // namespace shoal
