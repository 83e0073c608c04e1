// SPDX-License-Identifier: Apache-2.0
// Pages whose tables are made from files of measurements, so that the whole page can be made anew.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace shoal::bench {

// The page with what stands between each pair of lines
//
//   <!-- bench FILE: ONLY -->            commit and machine of FILE, then its rows whose stage
//   <!-- end of bench -->                contains ONLY, or A or B if ONLY is "A; B"; all without
//                                        ": ONLY"
//
//   <!-- bench scale of FILE FILE -->    what one replay, learner and link carry (scale_model.h)
//   <!-- end of bench -->
//
// replaced. `read` gives the text of a FILE, whose path starts at the folder of the page. Throws
// Error naming a line without its partner, a text that no row of the file contains, or a missing
// row.
std::string RewritePage(std::string_view page,
                        const std::function<std::string(const std::string& file)>& read);

}  // namespace shoal::bench
