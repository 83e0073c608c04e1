// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/page_parts.h"

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/program_file.h"
#include "launch/tools/web/page_texts.h"

namespace shoal::launch {

std::filesystem::path ChartLibrary() {
  constexpr char kFolder[] = "share/javascript/dygraphs";
  const std::filesystem::path own = ProgramFile().parent_path().parent_path() / kFolder;
  return std::filesystem::exists(own) ? own : std::filesystem::path("/usr") / kFolder;
}

std::map<std::string, PagePart> LoadPageParts(const std::filesystem::path& chart_library) {
  constexpr char kHtml[] = "text/html; charset=utf-8", kCss[] = "text/css; charset=utf-8",
                 kScript[] = "text/javascript; charset=utf-8";
  std::map<std::string, PagePart> parts{
      {"index.html", {kHtml, kIndexHtml}},     {"style.css", {kCss, kStyleCss}},
      {"page.js", {kScript, kPageJs}},         {"charts.js", {kScript, kChartsJs}},
      {"steering.js", {kScript, kSteeringJs}}, {"requests.js", {kScript, kRequestsJs}}};
  for (const auto& [name, type] :
       {std::pair("dygraph.min.js", kScript), std::pair("dygraph.min.css", kCss)}) {
    const std::filesystem::path file = chart_library / name;
    if (!std::filesystem::exists(file)) {
      throw RuntimeError("'{}', which draws the curves, is missing: apt-get install libjs-dygraphs",
                         file.string());
    }
    parts[name] = {type, ReadFile(file)};
  }
  return parts;
}

}  // namespace shoal::launch
