// SPDX-License-Identifier: Apache-2.0
// Routes: the meaning of a request, from its method and path. Pure.
//
//   GET   /                             the page
//         /page.js, /dygraph.min.js ... a part of the page
//         /api/runs                     every run and its state
//         /api/runs/NAME                films, reports, pictures, played episode of a run
//         /api/runs/NAME/top            output of `shoal top` for the run
//         /api/runs/NAME/curves         curves of the run
//         /files/NAME/videos/best.mp4   a file of the run's folder (served_file.h)
//         /episode/NAME                 the film of the run's played episode
//   POST  /api/runs/NAME/order          {"verb": "set" | "scale" | "stop", "arguments": [...]}
//         /api/runs/NAME/episode        plays an episode with the run's newest checkpoint
#pragma once

#include <string>
#include <string_view>

namespace shoal::launch {

enum class PageItem {
  kNothing,  // the path has no meaning
  kPart,     // part of the page, including "index.html"
  kRuns,
  kRun,
  kTop,
  kCurves,
  kFile,
  kEpisode,
  kOrder,
  kPlay,
};

struct PageRoute {
  PageItem item = PageItem::kNothing;
  std::string run{};   // name in the request; the run may not exist
  std::string file{};  // kPart: name; kFile: path below the run's folder
};

// `path`: without the query, with percent signs decoded. `acts`: the method is not GET or HEAD.
PageRoute ParsePageRoute(bool acts, std::string_view path);

}  // namespace shoal::launch
