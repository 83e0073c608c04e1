// SPDX-License-Identifier: Apache-2.0
// The file of the running program, and the words of its command line.
//
// A bundle (docs/install.md) starts its programs by the loader that it carries:
//   lib/ld-linux-x86-64.so.2 OPTIONS... --argv0 bin/NAME libexec/NAME ARGUMENTS...
// The kernel then reports the loader as the program. The functions below return bin/NAME, which
// starts the program again, and the program's own words.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal {

// Throws Error when /proc cannot be read.
std::filesystem::path ProgramFile();
std::vector<std::string> ProgramWords();

// The file of a program that the kernel reports as `executable`; `name` is the program's file name.
std::filesystem::path ProgramFileOf(const std::filesystem::path& executable,
                                    const std::string& name);
// The words of such a program. `command_line` is the content of /proc/self/cmdline, in which each
// word ends with '\0'.
std::vector<std::string> ProgramWordsOf(const std::filesystem::path& executable,
                                        const std::string& command_line);

}  // namespace shoal
