// SPDX-License-Identifier: Apache-2.0
// The file of the running program, and the words of its command line.
//
// A bundle (docs/install.md) starts its programs through a loader, which is a part of the bundle:
//   lib/ld-linux-x86-64.so.2 OPTIONS... --argv0 bin/NAME libexec/NAME ARGUMENTS...
// The kernel then reports the loader as the program. In this case, the functions below return
// bin/NAME, the file to execute if the program must be started again, and the program's own words.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal {

// Both functions throw Error if /proc cannot be read.
std::filesystem::path ProgramFile();
std::vector<std::string> ProgramWords();

// The program's file if the kernel reports `executable` as the program. `name`: the program's file
// name.
std::filesystem::path ProgramFileOf(const std::filesystem::path& executable,
                                    const std::string& name);
// The program's words if the kernel reports `executable` as the program. `command_line`: content of
// /proc/self/cmdline, in which each word ends with '\0'.
std::vector<std::string> ProgramWordsOf(const std::filesystem::path& executable,
                                        const std::string& command_line);

}  // namespace shoal
