#include "common/dds/wire_types.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shoal::dds {
namespace {

template <class M>
bool SurvivesTheWay(const M& message) {
  WireBuffers buffers;
  const auto wire = ToWire(message, &buffers);
  M back;
  return FromWire(wire, &back);
}

MetricsMessage ValidMetrics() {
  MetricsMessage message;
  message.role = "actor";
  message.time = 5;
  message.names = {"a", "b"};
  message.values = {1, 2};
  return message;
}

TEST(WireTypes, PayloadsAreBorrowedNotCopied) {
  const std::vector<uint8_t> payload{1, 2, 3};
  TransitionChunk chunk;
  chunk.payload = payload;
  WireBuffers buffers;
  EXPECT_EQ(ToWire(chunk, &buffers).payload._buffer, payload.data());
  EXPECT_FALSE(ToWire(chunk, &buffers).payload._release);
}

TEST(WireTypes, MetricsNeedARoleATimeAndAValuePerName) {
  EXPECT_TRUE(SurvivesTheWay(ValidMetrics()));
  MetricsMessage message = ValidMetrics();
  message.values.pop_back();
  EXPECT_FALSE(SurvivesTheWay(message));
  message = ValidMetrics();
  message.role = "";
  EXPECT_FALSE(SurvivesTheWay(message));
  message = ValidMetrics();
  message.time = NAN;
  EXPECT_FALSE(SurvivesTheWay(message));
  message = ValidMetrics();
  message.values[1] = NAN;  // a figure without meaning yet, such as a mean of nothing
  EXPECT_TRUE(SurvivesTheWay(message));
}

TEST(WireTypes, ControlStatesAreTheThreeThatExist) {
  EXPECT_TRUE(SurvivesTheWay(ControlMessage{.epoch = 1, .state = RunState::kRunning, .time = 1}));
  EXPECT_TRUE(SurvivesTheWay(ControlMessage{.epoch = 1, .state = RunState::kStopping, .time = 1}));
  EXPECT_FALSE(SurvivesTheWay(ControlMessage{.epoch = 1, .state = RunState{0}, .time = 1}));
  EXPECT_FALSE(SurvivesTheWay(ControlMessage{.epoch = 1, .state = RunState{4}, .time = 1}));
  EXPECT_FALSE(
      SurvivesTheWay(ControlMessage{.epoch = 1, .state = RunState::kRunning, .time = INFINITY}));
}

TEST(WireTypes, SessionsAndRequestsStartAtOne) {
  CreditsMessage credits;
  EXPECT_TRUE(SurvivesTheWay(credits));
  credits.credits = {{.replay_session = 1, .session = 2}, {.replay_session = 1, .session = 3}};
  EXPECT_TRUE(SurvivesTheWay(credits));
  credits.credits[1].session = 0;
  EXPECT_FALSE(SurvivesTheWay(credits));
  SampleRequest request;
  request.learner_session = 1;
  request.request = 1;
  request.batch = 1;
  EXPECT_TRUE(SurvivesTheWay(request));
  request.request = 0;
  EXPECT_FALSE(SurvivesTheWay(request));
  request.request = 1;
  request.batch = 0;
  EXPECT_FALSE(SurvivesTheWay(request));
}

// A sender of an older version leaves new fields of an @appendable type out.
TEST(WireTypes, StringsThatAreMissingReadAsEmpty) {
  WireBuffers buffers;
  const MetricsMessage message = ValidMetrics();
  shoal_idl_Metrics wire = ToWire(message, &buffers);
  wire.host = nullptr;
  MetricsMessage back;
  EXPECT_TRUE(FromWire(wire, &back));
  EXPECT_EQ(back.host, "");
}

}  // namespace
}  // namespace shoal::dds
