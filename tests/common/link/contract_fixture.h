// SPDX-License-Identifier: Apache-2.0
// Members of a run for the tests of the contract in hub.h. Each member executes commands
// (peer_commands.h). Members are processes for DDS, threads for the local link.
#pragma once

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/base/clock.h"
#include "common/link/hub.h"
#include "tests/common/link/contract_network.h"

namespace shoal::link {

struct Implementation {
  const char* name;
  std::unique_ptr<ContractNetwork> (*make)();
};

inline constexpr std::chrono::seconds kDeadline{20};

using Numbers = std::vector<uint64_t>;

// Returns first, first + 1, ... last.
inline Numbers Range(uint64_t first, uint64_t last) {
  Numbers numbers;
  for (uint64_t n = first; n <= last; ++n) numbers.push_back(n);
  return numbers;
}

class ContractTest : public ::testing::TestWithParam<Implementation> {
 protected:
  using Peer = std::unique_ptr<ContractPeer>;

  Peer Join(Role role) { return network_->Join(role); }

  // Makes a writer and a reader of `type`, and waits until both sides report the match.
  static void Connect(ContractPeer& writer, ContractPeer& reader, const std::string& type) {
    ASSERT_EQ(reader.Ask("subscribe " + type), "ok");
    ASSERT_EQ(writer.Ask("publish " + type), "ok");
    ExpectMatched(writer, type, 1);
    ExpectMatched(reader, type, 1);
  }

  static void ExpectMatched(ContractPeer& peer, const std::string& type, int count) {
    EXPECT_EQ(peer.Ask(fmt::format("match {} {} 20000", type, count)),
              fmt::format("matched {}", count))
        << type;
  }

  // Writes numbers FIRST to LAST and repeats refused writes until each is accepted.
  static void Write(ContractPeer& peer, const std::string& type, uint64_t first, uint64_t last,
                    size_t bytes = 1000, const std::string& key = "") {
    const uint64_t count = last - first + 1;
    EXPECT_THAT(peer.Ask(fmt::format("write {} {} {} {} {}", type, first, count, bytes, key)),
                ::testing::StartsWith(fmt::format("wrote {} ", count)));
  }

  static void ExpectReceived(ContractPeer& peer, const std::string& type, uint64_t count) {
    EXPECT_THAT(peer.Ask(fmt::format("received {} {} 20000", type, count)),
                ::testing::StartsWith(fmt::format("received {} ", count)));
  }

  // The numbers that were delivered, by key, in the order of the callbacks.
  static std::map<uint64_t, Numbers> SeenByKey(ContractPeer& peer, const std::string& type) {
    std::istringstream words(peer.Ask("seen " + type));
    std::string word;
    words >> word;
    EXPECT_EQ(word, "seen");
    std::map<uint64_t, Numbers> seen;
    uint64_t key = 0, number = 0;
    for (char colon = 0; words >> key >> colon >> number;) seen[key].push_back(number);
    return seen;
  }

  // Waits until the message `number` of `key` has been delivered. Returns false at the deadline.
  static bool WaitFor(ContractPeer& peer, const std::string& type, uint64_t key, uint64_t number) {
    const SteadyTime start = Now();
    for (;;) {
      const std::map<uint64_t, Numbers> seen = SeenByKey(peer, type);
      const auto of_key = seen.find(key);
      if (of_key != seen.end() && of_key->second.back() == number) return true;
      if (Now() - start > kDeadline) return false;
    }
  }

  static Numbers Seen(ContractPeer& peer, const std::string& type) {
    Numbers all;
    for (const auto& [key, numbers] : SeenByKey(peer, type)) {
      all.insert(all.end(), numbers.begin(), numbers.end());
    }
    return all;
  }

  // Holds the reader's callbacks and sends `number` from `writer`, so that one callback waits.
  static void HoldWith(ContractPeer& reader, ContractPeer& writer, const std::string& type,
                       uint64_t number) {
    ASSERT_EQ(reader.Ask("hold " + type), "ok");
    Write(writer, type, number, number);
    ASSERT_EQ(reader.Ask("waiting " + type + " 20000"), "yes");
  }

  // Writes first, first + 1, ... until a write is refused. Returns the refused number.
  static uint64_t WriteUntilRefused(ContractPeer& writer, const std::string& type, uint64_t first,
                                    size_t bytes) {
    constexpr uint64_t kEnough = 100;
    for (uint64_t n = first; n < first + kEnough; ++n) {
      const std::string answer = writer.Ask(fmt::format("try {} {} {}", type, n, bytes));
      if (answer.starts_with("refused ")) return n;
      EXPECT_THAT(answer, ::testing::StartsWith("sent "));
    }
    ADD_FAILURE() << "no write was refused";
    return 0;
  }

  const std::unique_ptr<ContractNetwork> network_ = GetParam().make();
};

// The tests of a suite run once for each implementation.
#define SHOAL_INSTANTIATE_CONTRACT(Suite)                                                        \
  INSTANTIATE_TEST_SUITE_P(Link, Suite,                                                          \
                           ::testing::Values(Implementation{"Local", &MakeLocalContractNetwork}, \
                                             Implementation{"Dds", &MakeDdsContractNetwork}),    \
                           [](const auto& test) { return std::string(test.param.name); })

}  // namespace shoal::link
