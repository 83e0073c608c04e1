// SPDX-License-Identifier: Apache-2.0
// Answers to the page's scripts, as JSON. Pure. Text from the network and from files that is not
// UTF-8 is replaced.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/wire/messages.h"
#include "launch/tools/web/played_episode.h"
#include "launch/tools/web/served_file.h"
#include "launch/watch/run_list.h"

namespace shoal::launch {

// {"error": message}
std::string ErrorAnswer(std::string_view message);

// {"view": as `shoal top --once --json`, "line", "advice", "columns", "rows": as `shoal top
// --once`,
//  "progress": figures of its first line, null where unknown, "events": [[time, text], ...]}
std::string TopAnswer(const RunViewMessage& view);

// {"runs": as `shoal runs --json`, "keys": those that `set` takes}
std::string RunsAnswer(const std::filesystem::path& dir, const std::vector<RunListing>& runs);

// {"checkpoint": newest or "", "files": [{path, bytes, modified}], "episode": {state, ...}}
std::string RunAnswer(const std::string& checkpoint, const std::vector<ServedName>& files,
                      const PlayedEpisode& episode);

struct PageOrder {
  std::string verb;
  std::vector<std::string> arguments;
};

// {"verb": "set" | "scale" | "stop", "arguments": [text, ...]}. Throws Error (usage) on anything
// else. What the arguments mean is for the run to judge.
PageOrder ParsePageOrder(const std::string& body);

}  // namespace shoal::launch
