// SPDX-License-Identifier: Apache-2.0
// Spelling help for unknown configuration keys.
#pragma once

#include <string>
#include <string_view>

namespace shoal::internal {

// The known key or section nearest to `path`: by its whole path, or by its last word when `path`
// has no section ("batch" -> "learner.batch"). Empty where more than half of `path` would have to
// change: that is another word, not a misspelt one.
std::string NearestKey(std::string_view path);

}  // namespace shoal::internal
