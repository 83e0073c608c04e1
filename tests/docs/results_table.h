// SPDX-License-Identifier: Apache-2.0
// The table of docs/results.md, computed from the figures in docs/results.
//
// docs/results/table.json lists the rows. A row has texts (`task`, `preset`, `input`, `privileged`,
// `page`; `busy` if other programs ran beside) and the files of its figures:
//
//   evals     evaluations of `shoal eval --json`, one per seed; FILE#MEMBER is a member of FILE
//   metas     a meta.json per seed: env steps, wall clock and cores
//   summary   an experiment's summary.json with `arm`: figures that evals and metas do not give
//   wall      a meta.json whose wall clock stands for the row instead
//   cores     cores of a run that was pinned to fewer than its meta.json names
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace shoal {

// Tables in Markdown, one for each group of table.json in `folder`. Throws Error naming the row if
// a file is missing or has none of the figures.
std::string ResultsTables(const std::filesystem::path& folder);

// The page with the text between its lines "<!-- results -->" and "<!-- end of results -->"
// replaced. Throws Error if it has no such lines.
std::string WithResults(std::string_view page, std::string_view tables);

}  // namespace shoal
