// SPDX-License-Identifier: Apache-2.0
// The table of configuration keys. Parsing, printing, --set and the documentation use this one
// table, so they all have the same keys. Internal to common/config.
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

// Allowed values of an integer, or of each element of a list of integers: low <= value <= high.
struct IntegerRange {
  int64_t low, high;
};
// Allowed values of a real number, of the start and the end of a schedule, or of the bounds of each
// interval in a map. `low` and `high` are themselves allowed unless low_open or high_open is set.
struct RealRange {
  double low, high;
  bool low_open = false, high_open = false;
};
struct Choices {
  std::vector<std::string_view> words;
};
// Limit for the value of a key that is a file name. File systems allow 255 bytes, but the names of
// some files consist of the name of the run's folder and a suffix.
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
