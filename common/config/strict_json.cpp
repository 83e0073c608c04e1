// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <set>

#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/base/one_line.h"
#include "common/config/config_io.h"

namespace shoal {
namespace {

using nlohmann::json;

// Observes the parser and refuses a key that its object already has.
class DuplicateGuard {
 public:
  explicit DuplicateGuard(const std::string& source) : source_(source) {}

  void OnEvent(json::parse_event_t event, const json& parsed) {
    if (event == json::parse_event_t::object_start) objects_.push_back({});
    if (event == json::parse_event_t::object_end) objects_.pop_back();
    if (event == json::parse_event_t::key) OnKey(parsed.get<std::string>());
  }

 private:
  struct Object {
    std::set<std::string> keys;
    std::string last;  // key whose value is being parsed
  };

  void OnKey(const std::string& key) {
    Object& object = objects_.back();
    object.last = key;
    if (object.keys.insert(key).second) return;
    std::string path;
    for (const Object& outer : objects_) path += (path.empty() ? "" : ".") + outer.last;
    throw UsageError("{}: duplicate key '{}'", source_, path);
  }

  const std::string& source_;
  std::vector<Object> objects_;
};

// "[json.exception.parse_error.101] parse error at line 1, ..." without the bracketed name.
std::string Reason(const json::exception& error) {
  const std::string_view text = error.what();
  const size_t end = text.find("] ");
  return Shortened(end == text.npos ? text : text.substr(end + 2), 300);
}

}  // namespace

json ParseStrictJson(std::string_view text, const std::string& source) {
  if (JsonTooDeep(text)) {
    throw UsageError("{}: nested more than {} deep", source, kMaxJsonDepth);
  }
  DuplicateGuard guard(source);
  const auto callback = [&](int, json::parse_event_t event, json& parsed) {
    guard.OnEvent(event, parsed);
    return true;
  };
  try {
    return json::parse(text, callback);
  } catch (const json::exception& e) {
    throw UsageError("{}: not valid JSON: {}", source, Reason(e));
  }
}

}  // namespace shoal
