// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/exit_reason.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace shoal::launch {
namespace {

constexpr std::streamoff kTail = 65536;

struct Line {
  std::string level;  // empty: not a line of Shoal's log
  std::string text;
};

// Parses "2026-01-31 12:00:00.000 learner error: text" (log.cpp). Other lines become the text.
Line ParseLine(const std::string& line) {
  std::istringstream words(line);
  std::string date, time, name, level;
  words >> date >> time >> name >> level;
  const bool dated = date.size() == 10 && date[4] == '-' && date[7] == '-';
  if (!dated || !level.ends_with(':')) return {"", line};
  level.pop_back();
  std::string text;
  std::getline(words >> std::ws, text);
  return {level, text};
}

}  // namespace

std::string ExitReason(const std::filesystem::path& output, uintmax_t from) {
  std::ifstream in(output, std::ios::binary);
  if (!in) return "";
  in.seekg(0, std::ios::end);
  const std::streamoff size = in.tellg();
  in.seekg(std::max(static_cast<std::streamoff>(from), size - kTail));
  std::string error, warning;
  for (std::string line; std::getline(in, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const Line read = ParseLine(line);
    if (read.level.empty() || read.level == "error" || read.level == "critical") error = read.text;
    if (read.level == "warning") warning = read.text;
  }
  return error.empty() ? warning : error;
}

}  // namespace shoal::launch
