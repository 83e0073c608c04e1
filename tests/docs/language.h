// SPDX-License-Identifier: Apache-2.0
// Rules of plain English that a program can check, over comments, texts in code, and pages.
//
//   opening    a paragraph of a comment that opens with What, Of, Where, As, With or Whoever
//   phrase     "nobody", "is told", "lies in", "the former" and similar words, anywhere in a file
//   width      a line of a page with over 100 columns, except tables, code and single links
//   reference  a comment or page that names a source or page which the tree does not have
//
// docs/decisions/0021-plain-english-is-tested.md gives the reasons.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace shoal {

struct LanguageFault {
  std::string rule;
  int line = 0;      // from 1
  std::string text;  // the faulty text
};

// Faults of one file, sorted by line. `file`: path from the root; `tree`: all files of the tree.
std::vector<LanguageFault> LanguageFaultsOf(const std::string& file, std::string_view text,
                                            const std::set<std::string>& tree);

// All files below `root`, as paths relative to `root`, except built, recorded and generated files.
std::set<std::string> FilesOf(const std::filesystem::path& root);

// Faults of all texts of the tree, by file.
std::map<std::string, std::vector<LanguageFault>> FindLanguageFaults(
    const std::filesystem::path& root);

}  // namespace shoal
