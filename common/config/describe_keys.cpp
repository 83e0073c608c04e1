#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "common/config/config_io.h"
#include "common/config/config_keys.h"
#include "common/config/value_json.h"

namespace shoal {
namespace {

// '|' ends a cell of a Markdown table.
std::string Cell(std::string_view text) {
  std::string cell;
  for (char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
  return cell;
}

}  // namespace

std::string DescribeKeys() {
  std::string table = "| key | default | takes | meaning |\n| --- | --- | --- | --- |\n";
  Config defaults;
  for (const internal::Key& key : internal::Keys()) {
    const nlohmann::json value =
        std::visit([](const auto* slot) { return nlohmann::json(*slot); }, key.slot(defaults));
    table += fmt::format("| `{}` | `{}` | {} | {} |\n", key.path, value.dump(),
                         Cell(internal::Expected(key)), Cell(key.meaning));
  }
  return table;
}

}  // namespace shoal
