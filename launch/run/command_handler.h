// SPDX-License-Identifier: Apache-2.0
// Executes the commands of users (stop, set, scale) and makes the replies. Independent of the
// transport.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/wire/messages.h"
#include "launch/run/live_settings.h"

namespace shoal::launch {

// Borrows the settings. One thread.
class CommandHandler {
 public:
  struct Effects {
    std::function<bool()> running;             // false as soon as the run is ending
    std::function<uint64_t()> env_steps;       // env steps of the run so far
    std::function<void()> stop;                // ends the run in order
    std::function<void(int, int)> scale;       // actors: from, to; may throw Error
    std::function<void(SettingChange)> note;   // records a change and sends it to the processes
    std::function<void(const Config&)> check;  // checks new settings on this machine; throws Error
  };

  CommandHandler(LiveSettings& settings, Effects effects)
      : settings_(settings), effects_(std::move(effects)) {}

  // Executes "stop", "set KEY=VALUE..." or "scale N". The reply contains the effect or the reason
  // of a refusal. Either all assignments of a command are made or none. Key and values in the reply
  // are those of the last assignment.
  ReplyMessage Handle(const CommandMessage& command);

 private:
  // Writes the effect into the reply.
  void Execute(const CommandMessage& command, ReplyMessage* reply);
  void Set(const std::vector<std::string>& assignments, ReplyMessage* reply);

  LiveSettings& settings_;
  const Effects effects_;
};

}  // namespace shoal::launch
