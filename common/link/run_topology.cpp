// SPDX-License-Identifier: Apache-2.0
#include "common/link/run_topology.h"

#include <algorithm>
#include <iterator>

#include "common/base/check.h"
#include "common/config/on_policy.h"

namespace shoal::link {
namespace {

constexpr RunProcess kServers[] = {
    {.role = Role::kCoordinator}, {.role = Role::kLearner}, {.role = Role::kReplay}};

const TopicRights& RightsOf(std::string_view topic) {
  static const std::vector<TopicRights> all = AllTopicRights();
  const auto rights = std::ranges::find(all, topic, &TopicRights::topic);
  CHECK(rights != all.end()) << topic;
  return *rights;
}

RunProcess Only(const std::vector<RunProcess>& processes, const char* role) {
  CHECK(processes.size() == 1) << "the run has " << processes.size() << " processes of role "
                               << role;
  return processes.front();
}

}  // namespace

std::span<const RunProcess> Servers() { return kServers; }

std::optional<int> FixedPort(Role role, uint32_t index) {
  const auto server = std::ranges::find(kServers, RunProcess{.role = role, .index = index});
  if (server == std::end(kServers)) return std::nullopt;
  return static_cast<int>(server - std::begin(kServers));
}

RunTopology::RunTopology(const Config& config, std::span<const int> actors_elsewhere) {
  // Each process starts after the processes that receive its work.
  for (const Role role : {Role::kReplay, Role::kLearner}) {
    if (role == Role::kReplay && LearnsOnPolicy(config)) continue;
    std::ranges::copy_if(kServers, std::back_inserter(children_),
                         [role](const RunProcess& server) { return server.role == role; });
  }
  int here = config.actors;
  for (const int actors : actors_elsewhere) here -= actors;
  CHECK(here >= 0) << config.actors << " actors, " << -here << " more on other hosts";
  uint32_t next = 0;
  const auto add_actors = [&](int count, uint32_t host) {
    for (int i = 0; i < count; ++i) {
      children_.push_back({.role = Role::kActor, .index = next++, .host = host});
    }
  };
  add_actors(here, 0);
  for (size_t i = 0; i < actors_elsewhere.size(); ++i) {
    add_actors(actors_elsewhere[i], static_cast<uint32_t>(i + 1));
  }
  children_.push_back({.role = Role::kEval});
}

std::vector<RunProcess> RunTopology::Of(Role role) const {
  return Among({role}, /*of_records=*/false);
}

RunProcess RunTopology::OnlyLearner() const {
  return Only(Of(Role::kLearner), RoleName(Role::kLearner));
}

RunProcess RunTopology::OnlyReplay() const {
  return Only(Of(Role::kReplay), RoleName(Role::kReplay));
}

std::vector<RunProcess> RunTopology::ActorsOn(uint32_t host) const {
  std::vector<RunProcess> actors = Of(Role::kActor);
  std::erase_if(actors, [host](const RunProcess& actor) { return actor.host != host; });
  return actors;
}

std::vector<RunProcess> RunTopology::Among(const std::vector<Role>& roles, bool of_records) const {
  const bool has_replay =
      std::ranges::find(children_, Role::kReplay, &RunProcess::role) != children_.end();
  std::vector<RunProcess> found;
  for (const RunProcess& child : children_) {
    if (of_records && has_replay && child.role == Role::kLearner) continue;
    if (std::ranges::find(roles, child.role) != roles.end()) found.push_back(child);
  }
  return found;
}

std::vector<RunProcess> RunTopology::WritersOf(std::string_view topic) const {
  return Among(RightsOf(topic).writers, topic == Topic<CreditsMessage>::kSettings.name);
}

std::vector<RunProcess> RunTopology::ReadersOf(std::string_view topic) const {
  return Among(RightsOf(topic).readers, topic == Topic<TransitionChunk>::kSettings.name);
}

bool RunTopology::CanWrite(std::string_view topic, std::string_view role, uint32_t index) const {
  const std::vector<Role>& roles = RightsOf(topic).writers;
  if (role == RoleName(Role::kActor)) {
    return index < kMostActors && std::ranges::find(roles, Role::kActor) != roles.end();
  }
  return std::ranges::any_of(WritersOf(topic), [&](const RunProcess& writer) {
    return writer.Name().role == role && writer.index == index;
  });
}

}  // namespace shoal::link
