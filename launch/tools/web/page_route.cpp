// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/page_route.h"

#include <vector>

namespace shoal::launch {
namespace {

// Parts between slashes. A path with more parts than any route is cut off and matches no route.
std::vector<std::string> Parts(std::string_view path) {
  constexpr size_t kMost = 5;
  std::vector<std::string> parts;
  while (!path.empty() && parts.size() < kMost) {
    path.remove_prefix(1);  // the slash
    parts.emplace_back(path.substr(0, path.find('/')));
    path.remove_prefix(parts.back().size());
  }
  if (!path.empty()) parts.emplace_back();
  return parts;
}

PageRoute ToSee(const std::vector<std::string>& parts) {
  const size_t n = parts.size();
  if (n == 1) return {PageItem::kPart, "", parts[0].empty() ? "index.html" : parts[0]};
  if (parts[0] == "api" && parts[1] == "runs") {
    if (n == 2) return {PageItem::kRuns};
    if (n == 3) return {PageItem::kRun, parts[2]};
    if (n == 4 && parts[3] == "top") return {PageItem::kTop, parts[2]};
    if (n == 4 && parts[3] == "curves") return {PageItem::kCurves, parts[2]};
  }
  if (parts[0] == "files" && n == 3) return {PageItem::kFile, parts[1], parts[2]};
  if (parts[0] == "files" && n == 4) {
    return {PageItem::kFile, parts[1], parts[2] + "/" + parts[3]};
  }
  if (parts[0] == "episode" && n == 2) return {PageItem::kEpisode, parts[1]};
  return {};
}

PageRoute ToDo(const std::vector<std::string>& parts) {
  if (parts.size() != 4 || parts[0] != "api" || parts[1] != "runs") return {};
  if (parts[3] == "order") return {PageItem::kOrder, parts[2]};
  if (parts[3] == "episode") return {PageItem::kPlay, parts[2]};
  return {};
}

}  // namespace

PageRoute ParsePageRoute(bool acts, std::string_view path) {
  if (path.empty() || path[0] != '/') return {};
  const std::vector<std::string> parts = Parts(path);
  return acts ? ToDo(parts) : ToSee(parts);
}

}  // namespace shoal::launch
