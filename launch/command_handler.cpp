#include "launch/command_handler.h"

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

std::string Describe(const SettingChange& change) {
  return fmt::format("{}: {} -> {}", change.key, change.from, change.to);
}

}  // namespace

ReplyMessage CommandHandler::Handle(const CommandMessage& command) {
  ReplyMessage reply{.client = command.client, .request = command.request, .text = {}};
  try {
    reply.text = Execute(command);
    reply.accepted = true;
  } catch (const Error& e) {
    reply.text = e.what();
  }
  return reply;
}

std::string CommandHandler::Execute(const CommandMessage& command) {
  if (command.verb == "stop") {
    if (!effects_.running()) return "the run is stopping already";
    effects_.stop();
    return "stopping in order";
  }
  if (command.verb != "set" && command.verb != "scale") {
    throw UsageError("unknown command '{}': another version of Shoal?", command.verb);
  }
  if (!effects_.running()) throw RuntimeError("the run is stopping: nothing is changed any more");
  if (command.verb == "set") {
    const SettingChange change = settings_.Assign(OnlyArgument(command));
    effects_.note(change);
    return Describe(change);
  }
  LiveSettings changed = settings_;
  const SettingChange change = changed.SetActors(OnlyArgument(command));
  effects_.scale(static_cast<int>(change.from), static_cast<int>(change.to));
  settings_ = changed;
  effects_.note(change);
  return Describe(change);
}

}  // namespace shoal::launch
