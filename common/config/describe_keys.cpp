// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "common/config/config_io.h"
#include "common/config/config_keys.h"
#include "common/config/key_description.h"
#include "common/config/value_json.h"

namespace shoal {
namespace {

// '|' ends a cell of a Markdown table.
std::string Cell(std::string_view text) {
  std::string cell;
  for (char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
  return cell;
}

std::vector<std::string_view> Words(const internal::Key& key, Config& config) {
  if (const auto* choices = std::get_if<internal::Choices>(&key.rule)) return choices->words;
  if (std::holds_alternative<bool*>(key.slot(config))) return {"true", "false"};
  return {};
}

}  // namespace

std::vector<KeyDescription> DescribeEachKey() {
  std::vector<KeyDescription> descriptions;
  Config defaults;
  for (const internal::Key& key : internal::Keys()) {
    const nlohmann::json value =
        std::visit([](const auto* slot) { return nlohmann::json(*slot); }, key.slot(defaults));
    descriptions.push_back({.path = key.path,
                            .default_value = value.dump(),
                            .takes = internal::Expected(key),
                            .meaning = key.meaning,
                            .words = Words(key, defaults)});
  }
  return descriptions;
}

std::string DescribeKeys() {
  std::string table = "| key | default | takes | meaning |\n| --- | --- | --- | --- |\n";
  for (const KeyDescription& key : DescribeEachKey()) {
    table += fmt::format("| `{}` | `{}` | {} | {} |\n", key.path, key.default_value,
                         Cell(key.takes), Cell(key.meaning));
  }
  return table;
}

}  // namespace shoal
