// SPDX-License-Identifier: Apache-2.0
// Manual pages in the format of man(7), from the texts of --help and the configuration's key table.
#pragma once

#include <string>

#include "launch/tools/manual/command_text.h"

namespace shoal::launch {

// A page of manual section 1: the program, its commands one after another, exit codes. `see_also`:
// content of the heading "see also", pages such as "shoal(1)" separated by commas; empty = no such
// heading.
std::string ProgramPage(const CommandText& program, const std::string& see_also);

// The page shoal-configuration(5) with every key.
std::string ConfigurationPage();

}  // namespace shoal::launch
