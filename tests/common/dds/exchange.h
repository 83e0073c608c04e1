// SPDX-License-Identifier: Apache-2.0
// Sends messages of each type from one process to another.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/common/dds/peer_process.h"
#include "tests/common/link/example_messages.h"
#include "tests/common/link/message_text.h"

namespace shoal::dds {

template <class M>
inline std::string Expected(const std::string& name, uint64_t n, size_t payload_bytes) {
  std::string text;
  WithExample<M>(n, ExamplePayload(n, payload_bytes),
                 [&](const M& message) { text = Describe(message); });
  return "got " + name + " " + text;
}

// Tests that the receiver gets message `n` of `name` with every field unchanged.
template <class M>
inline void ExpectSame(PeerProcess& sender, PeerProcess& receiver, const std::string& name,
                       uint64_t n = 41) {
  constexpr size_t kPayloadBytes = 100'000;
  EXPECT_EQ(receiver.Ask("show " + name), "ok");
  EXPECT_EQ(sender.Ask("publish " + name), "ok");
  EXPECT_EQ(sender.Ask("match " + name + " 1 10000"), "matched 1");
  EXPECT_THAT(sender.Ask(fmt::format("write {} {} 1 {}", name, n, kPayloadBytes)),
              ::testing::StartsWith("wrote 1 "));
  EXPECT_EQ(receiver.NextGot(), Expected<M>(name, n, kPayloadBytes));
}

}  // namespace shoal::dds
