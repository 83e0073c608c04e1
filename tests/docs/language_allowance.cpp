// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/language_allowance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <sstream>

#include "common/base/error.h"

namespace shoal {
namespace {

constexpr char kHeading[] =
    "# Faults of language that each file may still have: FILE RULE COUNT... The rules are in\n"
    "# tests/docs/language.h. Only `shoal-language --lower` changes this file: no number grows.\n";

int CountOf(const LanguageAllowance& counts, const std::string& file, const std::string& rule) {
  const auto entry = counts.find(file);
  if (entry == counts.end()) return 0;
  const auto count = entry->second.find(rule);
  return count == entry->second.end() ? 0 : count->second;
}

// Time of each line's last change, in seconds, by line from 1; lines that are not committed are the
// youngest. Empty where git does not know the file.
std::vector<long long> LineTimes(const std::filesystem::path& root, const std::string& file) {
  const std::string command =
      fmt::format("git -C '{}' blame --line-porcelain -- '{}' 2>/dev/null", root.string(), file);
  const std::unique_ptr<FILE, int (*)(FILE*)> blame(popen(command.c_str(), "r"), pclose);
  std::vector<long long> times = {0};
  char line[256];
  bool at_start = true;      // of a line that may be longer than `line`
  bool is_committed = true;  // lines that are not have a commit of zeros
  while (blame && std::fgets(line, sizeof line, blame.get()) != nullptr) {
    long long time = 0;
    if (at_start && std::sscanf(line, "committer-time %lld", &time) == 1) {
      times.push_back(is_committed ? time : std::numeric_limits<long long>::max());
      is_committed = true;
    } else if (at_start && std::string_view(line).starts_with("0000000000")) {
      is_committed = false;
    }
    at_start = std::string_view(line).ends_with('\n');
  }
  if (times.size() == 1) times.clear();
  return times;
}

std::string AboveText(const std::string& file, const std::string& rule,
                      std::vector<LanguageFault> faults, int allowed,
                      const std::filesystem::path& root) {
  const std::vector<long long> times =
      allowed == 0 ? std::vector<long long>() : LineTimes(root, file);
  const size_t excess = faults.size() - size_t(allowed);
  std::string text =
      fmt::format("{}: {} faults of '{}', allowed are {}. ", file, faults.size(), rule, allowed);
  if (times.empty()) {
    text += fmt::format("Change {} of these lines:", excess);
  } else {
    std::ranges::stable_sort(faults, std::greater(), [&](const LanguageFault& fault) {
      return size_t(fault.line) < times.size() ? times[size_t(fault.line)] : 0;
    });
    faults.resize(excess);
    text += "Change these lines, the youngest of them:";
  }
  for (const LanguageFault& fault : faults) {
    text += fmt::format("\n  {}:{}: {}", file, fault.line, fault.text);
  }
  return text;
}

}  // namespace

LanguageAllowance ReadAllowance(std::string_view text) {
  LanguageAllowance allowance;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string file, rule;
    int count = 0;
    words >> file;
    while (words >> rule >> count) {
      if (count < 1) throw RuntimeError("allowance '{}': expected counts of at least 1", line);
      allowance[file][rule] = count;
    }
    if (!words.eof() || !allowance.contains(file)) {
      throw RuntimeError("allowance '{}': expected FILE RULE COUNT...", line);
    }
  }
  return allowance;
}

std::string AllowanceText(const LanguageAllowance& allowance) {
  std::string text = kHeading;
  for (const auto& [file, rules] : allowance) {
    text += file;
    for (const auto& [rule, count] : rules) text += fmt::format(" {} {}", rule, count);
    text += '\n';
  }
  return text;
}

LanguageAllowance CountFaults(const FaultsByFile& faults) {
  LanguageAllowance counts;
  for (const auto& [file, found] : faults) {
    for (const LanguageFault& fault : found) ++counts[file][fault.rule];
  }
  return counts;
}

LanguageAllowance Lowered(const LanguageAllowance& allowance, const LanguageAllowance& counts) {
  LanguageAllowance lowered;
  for (const auto& [file, rules] : allowance) {
    for (const auto& [rule, allowed] : rules) {
      const int count = std::min(allowed, CountOf(counts, file, rule));
      if (count > 0) lowered[file][rule] = count;
    }
  }
  return lowered;
}

std::vector<std::string> Differences(const LanguageAllowance& allowance, const FaultsByFile& faults,
                                     const std::filesystem::path& root) {
  std::vector<std::string> differences;
  const LanguageAllowance counts = CountFaults(faults);
  for (const auto& [file, rules] : counts) {
    for (const auto& [rule, count] : rules) {
      const int allowed = CountOf(allowance, file, rule);
      if (count <= allowed) continue;
      std::vector<LanguageFault> of_rule;
      for (const LanguageFault& fault : faults.at(file)) {
        if (fault.rule == rule) of_rule.push_back(fault);
      }
      differences.push_back(AboveText(file, rule, std::move(of_rule), allowed, root));
    }
  }
  for (const auto& [file, rules] : allowance) {
    for (const auto& [rule, allowed] : rules) {
      const int count = CountOf(counts, file, rule);
      if (count < allowed) {
        differences.push_back(fmt::format(
            "{}: {} faults of '{}', allowed are {}. Lower the allowance: shoal-language --lower",
            file, count, rule, allowed));
      }
    }
  }
  return differences;
}

}  // namespace shoal
