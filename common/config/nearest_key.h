// SPDX-License-Identifier: Apache-2.0
// Spelling help for unknown configuration keys.
#pragma once

#include <string>
#include <string_view>

namespace shoal::internal {

// The known key or section that is nearest to `path`. Compares whole paths or, if `path` has no
// section, the last words of paths ("batch" -> "learner.batch"). Empty if more than half of `path`
// would have to change, because then `path` is another word rather than a misspelt key.
std::string NearestKey(std::string_view path);

}  // namespace shoal::internal
