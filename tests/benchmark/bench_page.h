// SPDX-License-Identifier: Apache-2.0
// Pages whose tables are generated from files of measurements.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace shoal::bench {

// Returns the page. The text between each of these pairs of lines is replaced:
//
//   <!-- bench FILE: ONLY -->            commit and machine of FILE, then the rows whose stage
//   <!-- end of bench -->                contains ONLY, or A or B if ONLY is "A; B"; without
//                                        ": ONLY" all rows
//
//   <!-- bench scale of FILE FILE -->    capacity of one replay, learner and link (scale_model.h)
//   <!-- end of bench -->
//
// `read` returns the text of a FILE, whose path is relative to the page. Throws Error naming the
// line if a line has no partner, the text if no row of the file contains ONLY, or the row if a row
// is missing.
std::string RewritePage(std::string_view page,
                        const std::function<std::string(const std::string& file)>& read);

}  // namespace shoal::bench
