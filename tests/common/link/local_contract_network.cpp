// SPDX-License-Identifier: Apache-2.0
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "common/link/local_network.h"
#include "tests/common/link/contract_network.h"
#include "tests/common/link/peer_commands.h"

namespace shoal::link {
namespace {

// Lines from one thread to another.
class LineQueue {
 public:
  void Put(std::string line) {
    const std::lock_guard lock(mutex_);
    lines_.push_back(std::move(line));
    arrived_.notify_all();
  }
  // Empty at the deadline.
  std::string Take(std::chrono::milliseconds deadline) {
    std::unique_lock lock(mutex_);
    if (!arrived_.wait_for(lock, deadline, [&] { return !lines_.empty(); })) return "";
    return PopFirst();
  }
  std::string Take() {
    std::unique_lock lock(mutex_);
    arrived_.wait(lock, [&] { return !lines_.empty(); });
    return PopFirst();
  }

 private:
  std::string PopFirst() {
    std::string line = std::move(lines_.front());
    lines_.pop_front();
    return line;
  }

  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<std::string> lines_;
};

class LocalPeer final : public ContractPeer {
 public:
  LocalPeer(LocalNetwork& network, Role role)
      : network_(network), hub_(network.Join(role)), thread_([this] { Serve(); }) {}
  ~LocalPeer() override { Quit(); }

  void Send(const std::string& command) override { commands_.Put(command); }
  std::string Answer(milliseconds deadline) override { return answers_.Take(deadline); }
  std::string NextGot(milliseconds deadline) override { return got_.Take(deadline); }
  void Quit() override {
    if (!thread_.joinable()) return;
    commands_.Put("quit");
    thread_.join();
    hub_.reset();
  }
  void Kill() override { network_.Abandon(*hub_); }

 private:
  void Serve() {
    PeerCommands commands(*hub_, [this](const std::string& line) { got_.Put(line); });
    for (std::string line; (line = commands_.Take()) != "quit";) answers_.Put(commands.Run(line));
  }

  LocalNetwork& network_;
  LineQueue commands_, answers_, got_;
  std::unique_ptr<Hub> hub_;
  std::thread thread_;  // last: it uses the others
};

class LocalContractNetwork final : public ContractNetwork {
 public:
  std::unique_ptr<ContractPeer> Join(Role role) override {
    return std::make_unique<LocalPeer>(network_, role);
  }

 private:
  LocalNetwork network_;
};

}  // namespace

std::unique_ptr<ContractNetwork> MakeLocalContractNetwork() {
  return std::make_unique<LocalContractNetwork>();
}

}  // namespace shoal::link
