// SPDX-License-Identifier: Apache-2.0
// The one table of configuration keys. Parsing, printing, --set and the documentation all use this
// table, so all of them have the same keys. Internal to common/config.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/config/config.h"

namespace shoal::internal {

// The member of a Config that a key names. Borrows the Config.
using Slot =
    std::variant<bool*, int*, int64_t*, double*, std::string*, StateBlocks*, std::vector<int>*,
                 std::vector<std::string>*, std::map<std::string, std::array<double, 2>>*,
                 std::map<std::string, CustomCamera>*, Schedule*, KeywordArguments*>;

// Bounds of an integer, or of each element of a list of integers; both ends included.
struct IntegerRange {
  int64_t low, high;
};
// Bounds of a real number, of both ends of a schedule or of each interval of a map. Each bound is
// included unless it is open.
struct RealRange {
  double low, high;
  bool low_open = false, high_open = false;
};
struct Choices {
  std::vector<std::string_view> words;
};
// Longest file name of a key. File systems allow 255 bytes; the names of files beside a run's
// folder append a suffix.
inline constexpr size_t kLongestFileName = 200;
// A text that is usable as a file name: letters, digits, '.', '_' and '-', not starting with '.' or
// '-'. May be empty if `optional`.
struct FileName {
  bool optional = false;
};
struct AnyValue {};

using Rule = std::variant<AnyValue, IntegerRange, RealRange, Choices, FileName>;

struct Key {
  std::string_view path;  // "learner.batch"
  Slot (*slot)(Config&);
  Rule rule;
  std::string_view meaning;  // one line, with the unit
};

// Every key, in the declaration order of Config.
std::span<const Key> Keys();

// Values that the key takes, for errors and documentation: "an integer in 1..65536", "f32 | bf16".
std::string Expected(const Key& key);

}  // namespace shoal::internal
