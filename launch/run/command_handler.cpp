// SPDX-License-Identifier: Apache-2.0
#include "launch/run/command_handler.h"

#include "common/base/error.h"

namespace shoal::launch {
namespace {

const std::string& OnlyArgument(const CommandMessage& command) {
  if (command.arguments.size() != 1) {
    throw UsageError("command '{}' takes one argument, got {}", command.verb,
                     command.arguments.size());
  }
  return command.arguments[0];
}

void Tell(const SettingChange& change, ReplyMessage* reply) {
  if (!reply->text.empty()) reply->text += "; ";
  reply->text += fmt::format("{}: {} -> {}", change.key, change.from, change.to);
  reply->key = change.key;
  reply->from = change.from;
  reply->to = change.to;
}

}  // namespace

ReplyMessage CommandHandler::Handle(const CommandMessage& command) {
  ReplyMessage reply{.client = command.client, .request = command.request};
  try {
    Execute(command, &reply);
    reply.accepted = true;
  } catch (const Error& e) {
    reply.text = e.what();
  }
  return reply;
}

void CommandHandler::Execute(const CommandMessage& command, ReplyMessage* reply) {
  if (command.verb == "stop") {
    reply->text = "the run is stopping already";
    if (!effects_.running()) return;
    effects_.stop();
    reply->text = "stopping the run";
    return;
  }
  if (command.verb != "set" && command.verb != "scale") {
    throw UsageError("unknown command '{}': another version of Shoal?", command.verb);
  }
  if (!effects_.running()) throw RuntimeError("the run is stopping: nothing is changed any more");
  if (command.verb == "set") return Set(command.arguments, reply);
  LiveSettings changed = settings_;
  const SettingChange change = changed.SetActors(OnlyArgument(command));
  effects_.scale(static_cast<int>(change.from), static_cast<int>(change.to));
  settings_ = changed;
  effects_.note(change);
  Tell(change, reply);
}

void CommandHandler::Set(const std::vector<std::string>& assignments, ReplyMessage* reply) {
  if (assignments.empty()) throw UsageError("command 'set' takes KEY=VALUE, got nothing");
  LiveSettings changed = settings_;
  std::vector<SettingChange> changes;
  for (const std::string& assignment : assignments) {
    changes.push_back(changed.Assign(assignment, effects_.env_steps()));
  }
  effects_.check(changed.config());
  settings_ = changed;
  for (const SettingChange& change : changes) {
    effects_.note(change);
    Tell(change, reply);
  }
}

}  // namespace shoal::launch
