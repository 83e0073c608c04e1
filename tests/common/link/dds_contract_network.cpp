// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "tests/common/dds/peer_process.h"
#include "tests/common/link/contract_network.h"

namespace shoal::link {
namespace {

using dds::PeerProcess;

// A process that another object may keep, as the coordinator's.
class DdsPeer final : public ContractPeer {
 public:
  explicit DdsPeer(std::shared_ptr<PeerProcess> process) : process_(std::move(process)) {}

  void Send(const std::string& command) override { process_->Send(command); }
  std::string Answer(milliseconds deadline) override { return process_->Answer(deadline); }
  std::string NextGot(milliseconds deadline) override { return process_->NextGot(deadline); }
  void Quit() override { process_->Quit(); }
  void Kill() override { process_->Kill(); }

 private:
  const std::shared_ptr<PeerProcess> process_;
};

class DdsContractNetwork final : public ContractNetwork {
 public:
  // The coordinator is there from the beginning: it claims the domain.
  std::unique_ptr<ContractPeer> Join(Role role) override {
    if (role == Role::kCoordinator) return std::make_unique<DdsPeer>(coordinator_);
    ClusterAddress address = coordinator_->address();
    if (role == Role::kClient) address.tag = "-";  // clients know host and port only
    return std::make_unique<DdsPeer>(std::make_shared<PeerProcess>(RoleName(role), address));
  }

 private:
  const std::shared_ptr<PeerProcess> coordinator_ = std::make_shared<PeerProcess>();
};

}  // namespace

std::unique_ptr<ContractNetwork> MakeDdsContractNetwork() {
  return std::make_unique<DdsContractNetwork>();
}

}  // namespace shoal::link
