// SPDX-License-Identifier: Apache-2.0
// The table of docs/results.md, computed from the figures in docs/results.
//
// docs/results/table.json lists the rows. A row has texts (`task`, `preset`, `input`, `privileged`,
// `page`; `busy` if other programs ran beside) and the files of its figures:
//
//   evals     evaluations of `shoal eval --json`, one per seed; FILE#MEMBER is a member of FILE
//   metas     a meta.json per seed: env steps, wall clock and cores
//   summary   an experiment's summary.json with `arm`: figures that evals and metas do not have
//   wall      a meta.json whose wall clock is used for the row instead
//   cores     cores of a run that was pinned to fewer cores than its meta.json says
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace shoal {

// Markdown tables, one for each group of table.json in `folder`. Throws Error naming the row if a
// file is missing or has none of the figures.
std::string ResultsTables(const std::filesystem::path& folder);

// Returns the page with the text between the lines "<!-- results -->" and "<!-- end of results -->"
// replaced. Throws Error if a line is missing.
std::string WithResults(std::string_view page, std::string_view tables);

}  // namespace shoal
