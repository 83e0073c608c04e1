// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/simulated_clients.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/interrupted.h"
#include "common/base/sleep.h"
#include "common/base/stop.h"
#include "common/link/reader.h"
#include "launch/client/attached_run.h"
#include "launch/client/run_orders.h"
#include "launch/watch/run_target.h"

namespace shoal::simulation {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kLookAtCalls{100};

// The promises of docs/monitoring.md; on purpose they are not the product's constants.
constexpr seconds kAnswered{5}, kInForceAfter{10}, kScaledAfter{60}, kSilence{15}, kLeavesAfter{10};
constexpr std::chrono::hours kStoppedAfter{1};
// A client looks at its deadlines twice a second.
constexpr seconds kSlack{2};

// While views keep coming.
SteadyTime::duration LongestWait(const ClientCall& call) {
  if (call.verb == "set") return kAnswered + kInForceAfter;
  if (call.verb == "scale") return kAnswered + kScaledAfter;
  return 2 * kAnswered + kStoppedAfter + kLeavesAfter;
}

bool BeginsWithOneOf(std::string_view line, const std::vector<std::string_view>& starts) {
  return std::ranges::any_of(starts,
                             [&](std::string_view start) { return line.starts_with(start); });
}

bool IsDocumentedError(const ClientCall& call) {
  if (call.code == kInterruptedExit) return call.verb == "attach";
  // The coordinator died before there was a run, or has not made one yet.
  if (call.code == 2) return call.last.starts_with("no run '");
  if (call.code != 1) return false;
  static const std::vector<std::string_view> kOfEach{
      "refused: ", "accepted, but the run's coordinator has been silent for 15 s: see shoal runs"};
  if (BeginsWithOneOf(call.last, kOfEach)) return call.verb != "attach";
  if (call.last.starts_with("run '")) {
    return call.last.ends_with("is not running") || call.last.ends_with("try again") ||
           call.last.find("did not answer") != std::string::npos ||
           (call.verb == "attach" && call.last.ends_with("has been silent for 15 s"));
  }
  if (call.verb == "set") return call.last.starts_with("accepted, but not in force");
  if (call.verb == "scale") return call.last.find(" actors have not reported") != std::string::npos;
  return call.verb == "stop" && call.last.find("another one has resumed") != std::string::npos;
}

}  // namespace

SteadyTime DeadlineOf(const ClientCall& call) {
  SteadyTime deadline =
      std::min(call.begun + LongestWait(call), std::max(call.begun, call.heard) + kSilence);
  // No other coordinator stops the run in its place.
  if (call.verb == "stop" && call.answerer && call.answerer->ended()) {
    deadline = std::min(deadline, call.answerer->ended_at() + kSilence);
  }
  return deadline + kSlack;
}

bool IsDocumented(const ClientCall& call) {
  if (call.failed) return IsDocumentedError(call);
  if (call.verb == "stop" || call.verb == "attach") return true;  // the run's own exit code
  if (call.code != 0) return false;
  if (call.last == "the run is ending") return true;
  if (call.verb == "set") return call.last.starts_with("in force: ");
  return call.last == call.arguments.at(0) + " actor(s) report" ||
         call.last.starts_with("another command has changed the number again: actors: ");
}

void SimulatedClients::Begin(const std::string& words) { Start(words); }

void SimulatedClients::Attach(milliseconds span) {
  const auto process = Start("attach");
  Thread([process, until = Now() + span] {
    SleepUntil(until);
    process->RequestStop();
  });
}

std::shared_ptr<SimulatedProcess> SimulatedClients::Start(const std::string& words) {
  std::istringstream in(words);
  auto call = std::make_unique<ClientCall>();
  in >> call->verb;
  for (std::string word; in >> word;) call->arguments.push_back(word);
  call->begun = Now();
  calls_.push_back(std::move(call));
  const uint64_t id = calls_.size();
  const std::string name = fmt::format("client-{}", id);
  return world_.processes.StartOther(name, link::Role::kClient,
                                     world_.folder.string() + ".client.log",
                                     [this, name, id, call = calls_.back().get()](link::Hub& hub) {
                                       return Run(name, call, id, hub);
                                     });
}

int SimulatedClients::Run(const std::string& name, ClientCall* call, uint64_t id, link::Hub& hub) {
  // These readers receive the same messages as the client.
  const link::Reader<RunViewMessage> views(hub,
                                           [call](const RunViewMessage&) { call->heard = Now(); });
  std::map<uint64_t, ReplyMessage> replies;
  const link::Reader<ReplyMessage> repeats(hub, [&](const ReplyMessage& reply) {
    if (reply.client != id) return;
    // A request that was sent again is answered again, and carried out once.
    const auto [first, fresh] = replies.try_emplace(reply.request, reply);
    if (!fresh && (first->second.accepted != reply.accepted || first->second.text != reply.text)) {
      world_.story.Violate(fmt::format("{} got a second reply", name));
    }
  });
  try {
    call->code = Carry(name, call, id, hub);
  } catch (const Interrupted& interrupted) {
    call->failed = true;
    call->last = interrupted.what();
    call->code = kInterruptedExit;
  } catch (const Error& error) {
    call->failed = true;
    call->last = error.what();
    call->code = error.exit_code();
  }
  call->ended = true;
  Judge(name, *call);
  return call->code;
}

int SimulatedClients::Carry(const std::string& name, ClientCall* call, uint64_t id,
                            link::Hub& hub) {
  const launch::RunTarget target = launch::ResolveTarget({.run = world_.folder, .peer = ""});
  launch::RunClient client(hub, target, id);
  if (call->verb == "attach") {
    launch::Progress progress("", [call](const std::string& line) { call->last = line; });
    return launch::ShowAttached(client, progress);
  }
  const auto say = [&](const std::string& line) {
    if (call->last.empty()) {
      call->answerer = world_.processes.Find("coordinator");
      world_.story.Add(name, line);
    }
    call->last = line;
  };
  if (call->verb == "stop") return launch::StopRun(client, target.folder, say);
  if (call->verb == "set") return launch::SetKeys(client, call->arguments, say);
  return launch::ScaleActors(client, std::atoi(call->arguments.at(0).c_str()), say);
}

void SimulatedClients::Judge(const std::string& name, const ClientCall& call) {
  world_.story.Add(name,
                   fmt::format("shoal {}: exit code {}: {}", call.verb, call.code, call.last));
  if (Now() > DeadlineOf(call)) {
    world_.story.Violate(fmt::format("{}: shoal {} ended {:.3f} s after its deadline", name,
                                     call.verb, SecondsSince(DeadlineOf(call))));
  }
  if (IsDocumented(call)) return;
  world_.story.Violate(fmt::format("{}: shoal {} may not end with code {} and '{}'", name,
                                   call.verb, call.code, call.last));
}

void SimulatedClients::WaitForAll() {
  for (size_t i = 0; i < calls_.size(); ++i) {
    const ClientCall& call = *calls_[i];
    const std::string name = fmt::format("client-{}", i + 1);
    while (!call.ended && Now() < DeadlineOf(call)) SleepFor(kLookAtCalls);
    if (!call.ended) {
      world_.story.Violate(fmt::format("{}: shoal {} still waits", name, call.verb));
      continue;
    }
    if (call.verb != "stop" || call.failed || !call.answerer) continue;
    const auto& exit = call.answerer->ended();
    if (exit && !exit->by_signal && exit->code != call.code) {
      world_.story.Violate(
          fmt::format("{}: shoal stop returned {}, the run {}", name, call.code, exit->code));
    }
  }
}

}  // namespace shoal::simulation
