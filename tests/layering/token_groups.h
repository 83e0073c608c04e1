// SPDX-License-Identifier: Apache-2.0
// Brackets in a source file's tokens.
#pragma once

#include <string_view>
#include <vector>

#include "tests/layering/source_tokens.h"

namespace shoal {

bool IsOpeningBracket(std::string_view text);
bool IsClosingBracket(std::string_view text);

// Index after the bracket that closes the bracket at `begin`; the number of tokens if there is
// none.
size_t BehindGroup(const std::vector<SourceToken>& tokens, size_t begin);

// Index after the `>` that closes the `<` at `begin`; the number of tokens if there is none.
size_t BehindAngles(const std::vector<SourceToken>& tokens, size_t begin);

}  // namespace shoal
