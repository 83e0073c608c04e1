// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/markdown.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <regex>
#include <sstream>

#include "common/base/files.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

const std::string kFence = "```";

// Reads a page line by line.
class Parser {
 public:
  explicit Parser(const std::string& file) { page_.file = file; }

  void Take(const std::string& line) {
    ++number_;
    const size_t indent = std::min(line.find_first_not_of(' '), line.size());
    if (line.compare(indent, kFence.size(), kFence) == 0) return TakeFence(line, indent);
    if (block_) {
      block_->lines.push_back(line.substr(std::min(indent, block_indent_)));
    } else {
      TakeText(line);
    }
  }
  Page Finish() { return std::move(page_); }

 private:
  void TakeFence(const std::string& line, size_t indent) {
    if (block_) {
      page_.blocks.push_back(*block_);
      block_.reset();
    } else {
      block_ =
          Block{.line = number_ + 1, .language = line.substr(indent + kFence.size()), .lines = {}};
      block_indent_ = indent;
    }
  }

  void TakeText(std::string line) {
    static const std::regex heading("^#+ (.*)$"), code("`([^`]+)`"),
        link(R"re(\]\(([^)\s]+)\)|<(?:img|a) [^>]*(?:src|href)="([^"]+)")re");
    std::smatch match;
    if (std::regex_match(line, match, heading)) page_.headings.push_back({number_, match[1]});
    for (std::sregex_iterator it(line.begin(), line.end(), code), end; it != end; ++it) {
      page_.code.push_back({number_, (*it)[1]});
    }
    line = std::regex_replace(line, code, "");
    for (std::sregex_iterator it(line.begin(), line.end(), link), end; it != end; ++it) {
      page_.links.push_back({number_, (*it)[(*it)[1].matched ? 1 : 2]});
    }
  }

  Page page_;
  int number_ = 0;
  std::optional<Block> block_;
  size_t block_indent_ = 0;
};

}  // namespace

Page ParsePage(const std::string& file, const std::string& text) {
  Parser parser(file);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) parser.Take(line);
  return parser.Finish();
}

std::vector<Page> ReadPages(const fs::path& root) {
  std::vector<std::string> files = {"README.md", "CHANGELOG.md"};
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs")) {
    if (entry.path().extension() != ".md") continue;
    files.push_back(entry.path().lexically_relative(root).string());
  }
  std::ranges::sort(files);
  std::vector<Page> pages;
  for (const std::string& file : files) pages.push_back(ParsePage(file, ReadFile(root / file)));
  return pages;
}

std::vector<std::string> AnchorsOf(const Page& page) {
  std::vector<std::string> anchors;
  std::map<std::string, int> seen;
  for (const Span& heading : page.headings) {
    std::string anchor;
    for (const char c : heading.text) {
      const auto byte = static_cast<unsigned char>(c);
      if (c == ' ') anchor += '-';
      // Letters outside of ASCII are kept. No linked heading has other signs outside of ASCII.
      if (std::isalnum(byte) != 0 || c == '-' || c == '_' || byte >= 0x80) {
        anchor += static_cast<char>(std::tolower(byte));
      }
    }
    const int times = seen[anchor]++;
    anchors.push_back(times == 0 ? anchor : anchor + "-" + std::to_string(times));
  }
  return anchors;
}

}  // namespace shoal
