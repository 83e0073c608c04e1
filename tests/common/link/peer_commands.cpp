// SPDX-License-Identifier: Apache-2.0
#include "tests/common/link/peer_commands.h"

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "tests/common/link/peer_endpoint.h"
#include "tests/common/link/round_trip.h"

namespace shoal::link {
namespace {

using std::chrono::milliseconds;
using Endpoint = PeerCommands::Endpoint;

// A command about one message type, whose words after the type are in `words`.
std::string RunTyped(const std::string& verb, std::istream& words, Hub& hub, Endpoint& endpoint) {
  uint64_t a = 0, b = 0, c = 0, key = 0;
  words >> a >> b >> c;
  const bool has_key = static_cast<bool>(words >> key);
  if (verb == "subscribe") return endpoint.Subscribe(hub, false), "ok";
  if (verb == "show") return endpoint.Subscribe(hub, true), "ok";
  if (verb == "unsubscribe") return endpoint.Unsubscribe(), "ok";
  if (verb == "unsubscribed") return endpoint.WaitForUnsubscribed(milliseconds(a)) ? "yes" : "no";
  if (verb == "publish") return endpoint.Publish(hub), "ok";
  if (verb == "unpublish") return endpoint.Unpublish(), "ok";
  if (verb == "match") return endpoint.Match(static_cast<int>(a), milliseconds(b));
  if (verb == "write") return endpoint.Write(a, b, c, has_key ? std::optional(key) : std::nullopt);
  if (verb == "scribble") return endpoint.Scribble(a, b, c);
  if (verb == "try") return endpoint.Try(a, b, false);
  if (verb == "announce") return endpoint.Try(a, b, true);
  if (verb == "received") return endpoint.Received(a, milliseconds(b));
  if (verb == "seen") return endpoint.Seen();
  if (verb == "hold") return endpoint.Hold(true), "ok";
  if (verb == "release") return endpoint.Hold(false), "ok";
  if (verb == "waiting") return endpoint.WaitForHeld(milliseconds(a)) ? "yes" : "no";
  if (verb == "overlaps") return endpoint.Overlaps();
  if (verb == "acknowledged") return endpoint.Acknowledged(milliseconds(a)) ? "yes" : "no";
  return "unknown command " + verb;
}

std::string DescribeMalformed(const Hub& hub) {
  std::string text = "malformed";
  for (const auto& [topic, count] : hub.Malformed()) text += fmt::format(" {}:{}", topic, count);
  return text;
}

}  // namespace

PeerCommands::PeerCommands(Hub& hub, std::function<void(const std::string&)> say) : hub_(hub) {
#define SHOAL_ADD(message, ...) \
  endpoints_.emplace(#message, std::make_unique<PeerEndpoint<message>>(#message, say));
  SHOAL_MESSAGES(SHOAL_ADD)
#undef SHOAL_ADD
}

PeerCommands::~PeerCommands() = default;

std::string PeerCommands::Run(const std::string& line) {
  std::istringstream words(line);
  std::string verb, name;
  words >> verb;
  if (verb == "malformed") return DescribeMalformed(hub_);
  if (verb == "answer") {
    answerer_ = std::make_unique<Answerer>(hub_);
    return "ok";
  }
  if (verb == "roundtrip") {
    uint64_t count = 0, bytes = 0;
    words >> count >> bytes;
    return RoundTrip(hub_, count, bytes);
  }
  words >> name;
  const auto endpoint = endpoints_.find(name);
  if (endpoint == endpoints_.end()) return "unknown message type " + name;
  return RunTyped(verb, words, hub_, *endpoint->second);
}

}  // namespace shoal::link
