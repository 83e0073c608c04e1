// SPDX-License-Identifier: Apache-2.0
#include "common/link/reader.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "common/base/error.h"
#include "common/dds/bus.h"
#include "common/link/metrics_writer.h"
#include "common/link/writer.h"
#include "common/wire/weights_parts.h"
// clang-format off
#include "shoal.h"
#include "dds/dds.h"
// clang-format on

// One process: writers and readers of one participant, where a write calls back at once.

namespace shoal::dds {
namespace {

class SubscriberTest : public ::testing::Test {
 protected:
  void SetUp() override { bus_ = ClaimDomain(TransportConfig{}, &address_); }

  ClusterAddress address_;
  std::unique_ptr<Bus> bus_;
};

// A writer of a topic that sends what our Publisher never would.
class RawWriter {
 public:
  RawWriter(int domain, const dds_topic_descriptor_t* type, const char* topic,
            dds_data_representation_id_t representation) {
    participant_ = dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr);
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
    dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_data_representation(qos, 1, &representation);
    const dds_entity_t handle = dds_create_topic(participant_, type, topic, qos, nullptr);
    writer_ = dds_create_writer(participant_, handle, qos, nullptr);
    EXPECT_GT(writer_, 0) << dds_strretcode(-writer_);
    dds_delete_qos(qos);
  }
  ~RawWriter() { dds_delete(participant_); }
  RawWriter(const RawWriter&) = delete;
  RawWriter& operator=(const RawWriter&) = delete;

  void Write(const void* sample) { EXPECT_EQ(dds_write(writer_, sample), DDS_RETCODE_OK); }

 private:
  dds_entity_t participant_, writer_;
};

TEST_F(SubscriberTest, ALateReaderGetsOnlyTheNewestControlMessage) {
  link::Writer<ControlMessage> publisher(*bus_);
  for (uint64_t epoch = 1; epoch <= 5; ++epoch) {
    EXPECT_TRUE(publisher.Write({.epoch = epoch, .state = RunState::kRunning, .time = 1}));
  }
  std::vector<uint64_t> epochs;
  const link::Reader<ControlMessage> subscriber(
      *bus_, [&](const ControlMessage& message) { epochs.push_back(message.epoch); });
  EXPECT_EQ(epochs, std::vector<uint64_t>{5});
}

TEST_F(SubscriberTest, ALateReaderGetsTheLast32Evaluations) {
  link::Writer<EvalMessage> publisher(*bus_);
  for (uint64_t n = 1; n <= 40; ++n) {
    publisher.Write({.env_steps = n, .version = {}, .checkpoint = "", .json = "{}"});
  }
  std::vector<uint64_t> env_steps;
  const link::Reader<EvalMessage> subscriber(
      *bus_, [&](const EvalMessage& message) { env_steps.push_back(message.env_steps); });
  ASSERT_EQ(env_steps.size(), 32u);
  EXPECT_EQ(env_steps.front(), 9u);
  EXPECT_EQ(env_steps.back(), 40u);
}

TEST_F(SubscriberTest, ALateReaderGetsTheLast16WordsAboutCredit) {
  link::Writer<CreditsMessage> publisher(*bus_);
  for (uint64_t stored = 1; stored <= 20; ++stored) {
    publisher.Write({{{.replay_session = 1,
                       .actor = 2,
                       .session = 7,
                       .stored = stored,
                       .allowed = stored,
                       .spec_hash = 0}}});
  }
  std::vector<uint64_t> stored;
  const link::Reader<CreditsMessage> subscriber(*bus_, [&](const CreditsMessage& message) {
    for (const Credit& credit : message.credits) stored.push_back(credit.stored);
  });
  ASSERT_EQ(stored.size(), 16u);
  EXPECT_EQ(stored.front(), 5u);
  EXPECT_EQ(stored.back(), 20u);
}

TEST_F(SubscriberTest, ALateReaderGetsNoOldMetrics) {
  link::Writer<ActorMetrics> publisher(*bus_);
  ActorMetrics message;
  message.role = "actor";
  publisher.Write(message);
  int received = 0;
  const link::Reader<ActorMetrics> subscriber(*bus_, [&](const ActorMetrics&) { ++received; });
  EXPECT_EQ(received, 0);
  publisher.Write(message);
  EXPECT_EQ(received, 1);
}

// 250 MB: what a convolutional network with fully connected layers has.
TEST_F(SubscriberTest, ALateReaderGetsTheNewestVersionOfALargePolicyWhole) {
  link::Writer<WeightsPart> publisher(*bus_);
  std::vector<uint8_t> bytes(250'000'000);
  WeightsMessage weights;
  weights.payload = bytes;
  for (const uint64_t update : {1, 2}) {
    for (size_t i = 0; i < bytes.size(); i += 4096)
      bytes[i] = static_cast<uint8_t>(i / 4096 * update);
    weights.version = {1, update};
    for (uint32_t part = 0; part < WeightsParts(bytes.size()); ++part) {
      ASSERT_TRUE(publisher.Write(PartOf<WeightsPart>(weights, part)));
    }
  }
  WeightsAssembler assembler;
  uint64_t complete = 0, refused = 0;
  const link::Reader<WeightsPart> subscriber(*bus_, [&](const WeightsPart& part) {
    const auto verdict = assembler.Add(part);
    if (verdict == WeightsAssembler::Verdict::kComplete) complete = part.version.update;
    if (verdict == WeightsAssembler::Verdict::kRefused) ++refused;
  });
  EXPECT_EQ(complete, 2u);
  EXPECT_EQ(refused, 0u);
  const std::string taken = assembler.Take();
  ASSERT_EQ(taken.size(), bytes.size());
  EXPECT_EQ(std::memcmp(taken.data(), bytes.data(), bytes.size()), 0);
}

TEST_F(SubscriberTest, WeightsAndEvaluationWeightsDoNotMix) {
  link::Writer<EvalWeightsPart> publisher(*bus_);
  const std::vector<uint8_t> payload(100, 1);
  EvalWeightsPart message;
  message.version = {1, 1};
  message.total_bytes = payload.size();
  message.payload = payload;
  publisher.Write(message);
  int training = 0, evaluation = 0;
  const link::Reader<WeightsPart> a(*bus_, [&](const WeightsPart&) { ++training; });
  const link::Reader<EvalWeightsPart> b(*bus_, [&](const EvalWeightsPart&) { ++evaluation; });
  EXPECT_EQ(training, 0);
  EXPECT_EQ(evaluation, 1);
}

TEST_F(SubscriberTest, BulkMessagesOfAnotherVersionAreCountedNotDelivered) {
  std::atomic<int> delivered{0};
  const link::Reader<WeightsPart> subscriber(*bus_, [&](const WeightsPart&) { ++delivered; });
  RawWriter writer(address_.domain, &shoal_idl_WeightsPart_desc, "weights_v2",
                   DDS_DATA_REPRESENTATION_XCDR1);
  std::vector<uint8_t> payload(10, 1);
  char checkpoint[] = "";
  shoal_idl_WeightsPart weights{1,         0, 0, 1, 1, 0, 10, 0, {10, 10, payload.data(), false},
                                checkpoint};
  writer.Write(&weights);
  EXPECT_EQ(delivered, 0);
  EXPECT_EQ(subscriber.Malformed(), 1u);
  weights.version = 2;
  writer.Write(&weights);
  EXPECT_EQ(delivered, 1);
  EXPECT_EQ(subscriber.Malformed(), 1u);
}

TEST_F(SubscriberTest, ControlOfAnUnknownStateIsCountedNotDelivered) {
  std::atomic<int> delivered{0};
  const link::Reader<ControlMessage> subscriber(*bus_, [&](const ControlMessage&) { ++delivered; });
  RawWriter writer(address_.domain, &shoal_idl_Control_desc, "control",
                   DDS_DATA_REPRESENTATION_XCDR2);
  shoal_idl_Control control{};
  control.epoch = 1;
  control.state = 77;
  writer.Write(&control);
  EXPECT_EQ(delivered, 0);
  EXPECT_EQ(subscriber.Malformed(), 1u);
}

TEST_F(SubscriberTest, ReportsCarryTheMalformedMessagesOfEachTopic) {
  MetricsMessage report;
  const link::Reader<ActorMetrics> reports(*bus_, [&](const ActorMetrics& m) { report = m; });
  const link::Reader<ControlMessage> control_reader(*bus_, [](const ControlMessage&) {});
  RawWriter writer(address_.domain, &shoal_idl_Control_desc, "control",
                   DDS_DATA_REPRESENTATION_XCDR2);
  shoal_idl_Control control{};
  control.state = 77;
  writer.Write(&control);
  link::MetricsWriter<ActorMetrics> publisher(*bus_);
  MetricsMessage message;
  message.role = "actor";
  message.names = {"made"};
  message.values = {3};
  ASSERT_TRUE(publisher.Write(message));
  EXPECT_EQ(report.names,
            (std::vector<std::string>{"made", "malformed_control", "malformed_metrics_actor"}));
  EXPECT_EQ(report.values, (std::vector<double>{3, 1, 0}));
}

TEST_F(SubscriberTest, NoCallbackRunsAfterTheDestructor) {
  link::Writer<ControlMessage> publisher(*bus_);
  std::atomic<bool> alive{false};
  std::atomic<int> calls{0}, late_calls{0}, writes{0};
  const std::jthread writer([&](const std::stop_token& stop) {
    for (uint64_t n = 1; !stop.stop_requested(); ++n) {
      publisher.Write({.epoch = n, .state = RunState::kRunning, .time = 1});
      ++writes;
    }
  });
  for (int i = 0; i < 300; ++i) {
    const int before = calls;
    alive = true;
    {
      const link::Reader<ControlMessage> subscriber(*bus_, [&](const ControlMessage&) {
        ++calls;
        if (!alive) ++late_calls;
      });
      while (calls < before + 3) std::this_thread::yield();
    }
    alive = false;
    const int after = writes;
    while (writes < after + 3) std::this_thread::yield();
  }
  EXPECT_EQ(late_calls, 0);
}

TEST_F(SubscriberTest, MatchedCountsPeersOfBothSides) {
  link::Writer<ControlMessage> publisher(*bus_);
  EXPECT_EQ(publisher.Matched(), 0);
  const auto ignore = [](const ControlMessage&) {};
  const link::Reader<ControlMessage> first(*bus_, ignore);
  {
    const link::Reader<ControlMessage> second(*bus_, ignore);
    EXPECT_EQ(publisher.Matched(), 2);
    EXPECT_EQ(second.Matched(), 1);
  }
  EXPECT_EQ(publisher.Matched(), 1);
}

TEST(SubscriberDeathTest, OnlyLearnerAndReplayReachTheBatchTopics) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(
      {
        ClusterAddress address;
        const auto bus = ClaimDomain(TransportConfig{}, &address);
        const link::Reader<BatchPart> subscriber(*bus, [](const BatchPart&) {});
      },
      "batch domain");
}

}  // namespace
}  // namespace shoal::dds
