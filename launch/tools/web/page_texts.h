// SPDX-License-Identifier: Apache-2.0
// The files of launch/tools/web/pages, built into the program.
#pragma once

namespace shoal::launch {

extern const char* const kIndexHtml;
extern const char* const kStyleCss;
extern const char* const kPageJs;
extern const char* const kChartsJs;
extern const char* const kSteeringJs;
extern const char* const kRequestsJs;

}  // namespace shoal::launch
