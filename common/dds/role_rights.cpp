#include "common/dds/role_rights.h"

#include "common/dds/domain_xml.h"
// clang-format off
#include "common/dds/topics.h"
// clang-format on

namespace shoal::dds {
namespace {

template <class... Messages>
std::vector<std::string> Names() {
  return {Topic<Messages>::kSettings.name...};
}

}  // namespace

std::vector<RoleRights> AllRoleRights() {
  return {
      {RoleName(Role::kCoordinator), Names<ControlMessage, RunViewMessage, ReplyMessage>(),
       Names<MetricsMessage, EvalMessage, CommandMessage>()},
      {RoleName(Role::kLearner),
       Names<WeightsMessage, EvalWeightsMessage, SampleRequest, MetricsMessage>(),
       Names<BatchShard, EvalMessage, ControlMessage>()},
      {RoleName(Role::kReplay), Names<CreditsMessage, BatchShard, MetricsMessage>(),
       Names<TransitionChunk, SampleRequest, ControlMessage>()},
      {RoleName(Role::kActor), Names<TransitionChunk, EvalMessage, MetricsMessage>(),
       Names<CreditsMessage, WeightsMessage, EvalWeightsMessage, ControlMessage>()},
      {RoleName(Role::kClient), Names<CommandMessage>(), Names<RunViewMessage, ReplyMessage>()},
  };
}

}  // namespace shoal::dds
