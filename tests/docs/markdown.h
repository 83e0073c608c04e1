// SPDX-License-Identifier: Apache-2.0
// The parts of a Markdown page that tests check. Supports the syntax of Shoal's pages: fenced
// blocks (also within lists), code spans, headings with #, links and images on one line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal {

struct Span {
  int line = 0;  // from 1
  std::string text;
};

struct Block {
  int line = 0;          // number of the first line of content
  std::string language;  // "sh"; may be empty
  std::vector<std::string> lines;
};

struct Page {
  std::string file;  // path from the root: "docs/install.md"
  std::vector<Block> blocks;
  std::vector<Span> headings;  // without the #
  std::vector<Span> code;      // `...` outside of blocks
  std::vector<Span> links;     // targets of links
};

Page ParsePage(const std::string& file, const std::string& text);

// Reads README.md, CHANGELOG.md and every page below docs, sorted by name.
std::vector<Page> ReadPages(const std::filesystem::path& root);

// The anchors of the page's headings, as GitHub generates them.
std::vector<std::string> AnchorsOf(const Page& page);

}  // namespace shoal
