// SPDX-License-Identifier: Apache-2.0
#include "common/link/plane_hub.h"

#include <gtest/gtest.h>

#include "common/link/local_network.h"
#include "common/link/reader.h"
#include "common/link/writer.h"

namespace shoal::link {
namespace {

TEST(PlaneHub, TheOperatePlaneIsOneHubsAndTheRestTheOthers) {
  LocalNetwork inside, outside;
  const auto roles = inside.Join(Role::kCoordinator), clients = outside.Join(Role::kCoordinator);
  const auto actor = inside.Join(Role::kActor), client = outside.Join(Role::kClient);
  const auto stranger = inside.Join(Role::kClient);
  PlaneHub hub(*roles, *clients);
  Writer<ControlMessage> control(hub);
  Writer<RunViewMessage> views(hub);
  const Reader<ControlMessage> at_actor(*actor, [](const ControlMessage&) {});
  const Reader<RunViewMessage> at_client(*client, [](const RunViewMessage&) {});
  const Reader<RunViewMessage> at_stranger(*stranger, [](const RunViewMessage&) {});
  EXPECT_EQ(control.Matched(), 1);
  EXPECT_EQ(views.Matched(), 1);
  EXPECT_EQ(at_client.Matched(), 1);
  EXPECT_EQ(at_stranger.Matched(), 0);
}

TEST(PlaneHub, CountsTheTopicsOfBoth) {
  LocalNetwork inside, outside;
  const auto roles = inside.Join(Role::kCoordinator), clients = outside.Join(Role::kCoordinator);
  PlaneHub hub(*roles, *clients);
  const Reader<EvalMessage> evaluations(hub, [](const EvalMessage&) {});
  const Reader<CommandMessage> commands(hub, [](const CommandMessage&) {});
  EXPECT_EQ(hub.Malformed(), (std::map<std::string, uint64_t>{{"command", 0}, {"eval", 0}}));
}

}  // namespace
}  // namespace shoal::link
