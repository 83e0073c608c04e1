// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/page_route.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

void Expect(bool acts, const std::string& path, PageItem item, const std::string& run = "",
            const std::string& file = "") {
  const PageRoute route = ParsePageRoute(acts, path);
  EXPECT_EQ(route.item, item) << path;
  EXPECT_EQ(route.run, run) << path;
  EXPECT_EQ(route.file, file) << path;
}

TEST(PageRoute, EachThingThatThereIsToSee) {
  Expect(false, "/", PageItem::kPart, "", "index.html");
  Expect(false, "/page.js", PageItem::kPart, "", "page.js");
  Expect(false, "/api/runs", PageItem::kRuns);
  Expect(false, "/api/runs/reach", PageItem::kRun, "reach");
  Expect(false, "/api/runs/reach/top", PageItem::kTop, "reach");
  Expect(false, "/api/runs/reach/curves", PageItem::kCurves, "reach");
  Expect(false, "/files/reach/report.html", PageItem::kFile, "reach", "report.html");
  Expect(false, "/files/reach/videos/best.mp4", PageItem::kFile, "reach", "videos/best.mp4");
  Expect(false, "/episode/reach", PageItem::kEpisode, "reach");
}

TEST(PageRoute, EachThingThatThereIsToDo) {
  Expect(true, "/api/runs/reach/order", PageItem::kOrder, "reach");
  Expect(true, "/api/runs/reach/episode", PageItem::kPlay, "reach");
}

TEST(PageRoute, WhatIsDoneIsNotSeenNorTheOtherWayRound) {
  for (const char* path : {"/api/runs/reach/order", "/api/runs/reach/episode"}) {
    Expect(false, path, PageItem::kNothing);
  }
  for (const char* path : {"/", "/api/runs", "/api/runs/reach/top", "/files/reach/report.html"}) {
    Expect(true, path, PageItem::kNothing);
  }
}

TEST(PageRoute, EverythingElseIsNothing) {
  for (const char* path : {"", "x", "/api", "/api/", "/api/runs/reach/", "/api/runs/reach/top/x",
                           "/files/reach", "/files/reach/a/b/c", "/files/reach/a/b/c/d/e/f",
                           "/episode", "/episode/a/b", "/api/other"}) {
    const PageItem item = ParsePageRoute(false, path).item;
    // A name alone is looked for among the page's parts, and not found there.
    EXPECT_TRUE(item == PageItem::kNothing || item == PageItem::kPart) << path;
  }
  Expect(false, "/files/reach/a/b/c", PageItem::kNothing);
}

}  // namespace
}  // namespace shoal::launch
