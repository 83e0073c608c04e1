// SPDX-License-Identifier: Apache-2.0
// The values that a key takes, in words.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <limits>

#include "common/config/config_keys.h"

namespace shoal::internal {
namespace {

// The rule of a key in words; empty if its type says everything.
struct RuleText {
  std::string operator()(const AnyValue&) const { return ""; }
  std::string operator()(const IntegerRange& r) const {
    if (r.high == std::numeric_limits<int64_t>::max()) return fmt::format("of at least {}", r.low);
    return fmt::format("in {}..{}", r.low, r.high);
  }
  std::string operator()(const RealRange& r) const {
    return fmt::format("in {}{}, {}{}", r.low_open ? '(' : '[', r.low, r.high,
                       r.high_open ? ')' : ']');
  }
  std::string operator()(const Choices& c) const {
    return fmt::format("{}", fmt::join(c.words, " | "));
  }
  std::string operator()(const FileName& f) const {
    return fmt::format("usable as a file name of at most {} characters{}", kLongestFileName,
                       f.optional ? ", or empty" : "");
  }
};

struct TypeText {
  std::string operator()(const bool*) const { return "true or false"; }
  std::string operator()(const int*) const { return "an integer"; }
  std::string operator()(const int64_t*) const { return "an integer"; }
  std::string operator()(const double*) const { return "a number"; }
  std::string operator()(const std::string*) const { return "a string"; }
  std::string operator()(const StateBlocks*) const {
    return "true, false or a list of block names";
  }
  std::string operator()(const std::vector<int>*) const { return "a list of integers"; }
  std::string operator()(const std::vector<std::string>*) const { return "a list of strings"; }
  std::string operator()(const std::map<std::string, std::array<double, 2>>*) const {
    return "an object of intervals {name: [low, high], ...}, low <= high, each";
  }
  std::string operator()(const KeywordArguments*) const {
    return "an object of JSON {name: value, ...}";
  }
  std::string operator()(const Schedule*) const {
    return "a number, or \"linear(START,END,ENV_STEPS)\", each end";
  }
  std::string operator()(const std::map<std::string, CustomCamera>*) const {
    return "an object {name: {lookat: [x, y, z], distance: > 0, azimuth, elevation: -90..90, body: "
           "optional}, ...}";
  }
};

}  // namespace

std::string Expected(const Key& key) {
  std::string rule = std::visit(RuleText{}, key.rule);
  if (std::holds_alternative<Choices>(key.rule)) return rule;
  Config scratch;
  const std::string type =
      std::visit([](const auto* slot) { return TypeText{}(slot); }, key.slot(scratch));
  return rule.empty() ? type : type + " " + rule;
}

}  // namespace shoal::internal
