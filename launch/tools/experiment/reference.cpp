// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/reference.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/config/shared_data.h"
#include "launch/tools/experiment/json_members.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr char kReferenceSchema[] = "shoal-reference-1";
constexpr char kReferenceKind[] = "references";

std::vector<double> ReadReturns(JsonMembers& members, size_t size) {
  const char* const expected = "a list with a number for each of 'frames'";
  const ordered_json& list = members.Need("returns");
  if (!list.is_array() || list.size() != size) members.Refuse("returns", list, expected);
  std::vector<double> returns;
  for (const ordered_json& value : list) {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      members.Refuse("returns", list, expected);
    }
    returns.push_back(value.get<double>());
  }
  return returns;
}

ReferenceResult ReadResult(const ordered_json& object, const std::string& where) {
  JsonMembers members(object, where);
  ReferenceResult result;
  result.method = members.NeedText("method");
  result.source = members.Text("source", "");
  result.task = members.NeedText("task");
  const ordered_json& list = members.Need("frames");
  const auto frames = IncreasingNumbers(list);
  if (!frames) members.Refuse("frames", list, "a list of increasing integers of at least 1");
  result.frames = *frames;
  result.returns = ReadReturns(members, result.frames.size());
  members.RefuseOthers();
  return result;
}

void RefuseSecond(const std::vector<ReferenceResult>& results, const std::string& where) {
  const ReferenceResult& last = results.back();
  const auto same = [&](const ReferenceResult& other) {
    return other.method == last.method && other.task == last.task;
  };
  if (std::ranges::count_if(results, same) > 1) {
    throw UsageError("{}: method '{}' has another result on task '{}'", where, last.method,
                     last.task);
  }
}

}  // namespace

Reference ParseReference(const ordered_json& object, const std::string& source,
                         const std::string& name) {
  JsonMembers members(object, source);
  members.NeedSchema(kReferenceSchema);
  Reference reference{.name = name, .source = members.NeedText("source")};
  const ordered_json& list = members.Need("results");
  if (!list.is_array() || list.empty()) {
    members.Refuse("results", list, "a list of at least one result");
  }
  for (const ordered_json& entry : list) {
    const std::string where = fmt::format("{}: result {}", source, reference.results.size() + 1);
    reference.results.push_back(ReadResult(entry, where));
    RefuseSecond(reference.results, where);
  }
  members.RefuseOthers();
  return reference;
}

Reference ReadReference(const fs::path& file) {
  const std::string text = ReadFile(file);
  ParseStrictJson(text, file);  // refuses broken text and duplicate keys
  return ParseReference(ParseBoundedJson<ordered_json>(text), file, file.stem());
}

std::vector<std::string> ListReferences() { return ListSharedData(kReferenceKind); }

fs::path FindReference(const std::string& file_or_name) {
  return FindFileOrSharedData(kReferenceKind, "reference", file_or_name);
}

}  // namespace shoal::launch
