// SPDX-License-Identifier: Apache-2.0
// The table of docs/results.md, computed from the files in docs/results.
//
// docs/results/table.json lists the rows. A row has texts (`task`, `preset`, `input`, `privileged`,
// `page`; `busy` if other programs ran at the same time) and names the files of its results:
//
//   evals     evaluations of `shoal eval --json`, one per seed; FILE#MEMBER is a member of FILE
//   metas     a meta.json per seed: env steps, wall clock and cores
//   summary   an experiment's summary.json with `arm`: results that evals and metas do not have
//   wall      a meta.json whose wall clock replaces that of metas
//   cores     cores of a run that was pinned to fewer cores than its meta.json says
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace shoal {

// Markdown tables, one for each group of table.json in `folder`. If a file of a row is missing or
// has none of the results, throws Error naming the row.
std::string ResultsTables(const std::filesystem::path& folder);

// Returns the page. `tables` replaces the text between the lines "<!-- results -->" and "<!-- end
// of results -->". Throws Error if a line is missing.
std::string WithResults(std::string_view page, std::string_view tables);

}  // namespace shoal
