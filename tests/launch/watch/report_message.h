// SPDX-License-Identifier: Apache-2.0
// A process's report in the form in which the network delivers it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/wire/messages.h"

namespace shoal::launch {

// `figures`: pairs of name and value.
template <class Figures = std::vector<std::pair<std::string, double>>>
MetricsMessage Report(const std::string& role, uint32_t id, int32_t pid, double time,
                      const Figures& figures) {
  MetricsMessage message;
  message.role = role;
  message.id = id;
  message.pid = pid;
  message.time = time;
  for (const auto& [name, value] : figures) {
    message.names.push_back(name);
    message.values.push_back(value);
  }
  return message;
}

}  // namespace shoal::launch
