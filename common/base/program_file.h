// SPDX-License-Identifier: Apache-2.0
// The file of the running program, and the words that it was started with.
//
// A bundle (docs/install.md) starts its programs by the loader that it carries:
//   lib/ld-linux-x86-64.so.2 OPTIONS... --argv0 bin/NAME libexec/NAME ARGUMENTS...
// The kernel then takes the loader for the program. The functions below return bin/NAME, which is
// what starts the program again, and its own words.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal {

// Throws Error when /proc cannot be read.
std::filesystem::path ProgramFile();
std::vector<std::string> ProgramWords();

// The file of a program that the kernel knows as `executable`, named `name` in its words.
std::filesystem::path ProgramFileOf(const std::filesystem::path& executable,
                                    const std::string& name);
// The words of that program, from its /proc/self/cmdline, which ends each by '\0'.
std::vector<std::string> ProgramWordsOf(const std::filesystem::path& executable,
                                        const std::string& command_line);

}  // namespace shoal
