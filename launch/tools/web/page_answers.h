// SPDX-License-Identifier: Apache-2.0
// Answers to the page's scripts, as JSON. Pure. Invalid UTF-8 in texts from the network and from
// files is replaced.
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

// {"view": output of `shoal top --once --json`,
//  "line", "advice", "columns", "rows": parts of the output of `shoal top --once`,
//  "progress": numbers of the first line, null if unknown,
//  "events": [[time, text], ...]}
std::string TopAnswer(const RunViewMessage& view);

// {"runs": output of `shoal runs --json`, "keys": keys that `set` accepts}
std::string RunsAnswer(const std::filesystem::path& dir, const std::vector<RunListing>& runs);

// {"checkpoint": name of the newest, or "", "files": [{path, bytes, modified}],
//  "episode": {state, ...}}
std::string RunAnswer(const std::string& checkpoint, const std::vector<ServedName>& files,
                      const PlayedEpisode& episode);

struct PageOrder {
  std::string verb;
  std::vector<std::string> arguments;
};

// Parses {"verb": "set" | "scale" | "stop", "arguments": [text, ...]}. Throws Error (usage) on
// anything else. The run checks the arguments.
PageOrder ParsePageOrder(const std::string& body);

}  // namespace shoal::launch
