// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/flow_ages.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "common/wire/process_name.h"
#include "tests/replay_server/record_script.h"

namespace shoal::replay {
namespace {

constexpr int64_t kSecond = 1'000'000'000;
constexpr int kCredits = 3;

class FlowAgesTest : public ::testing::Test {
 protected:
  void Ask(uint64_t session, uint64_t request) {
    SampleRequest message;
    message.learner_session = session;
    message.request = request;
    ages_.OnRequest(message);
  }
  // A chunk of one record, made `age_seconds` ago by the weights of (session, update).
  void Store(uint64_t session, uint64_t update, double age_seconds) {
    StoreMadeAt(session, update, kNow - static_cast<int64_t>(age_seconds * kSecond));
  }
  void StoreMadeAt(uint64_t session, uint64_t update, int64_t time_ns) {
    std::vector<uint64_t> words(static_cast<size_t>(layout_.record_bytes()) / 8);
    auto* bytes = reinterpret_cast<uint8_t*>(words.data());
    RecordHeader& header = RecordLayout::Header(bytes);
    header.weights_session = session;
    header.weights_update = update;
    header.time_ns = time_ns;
    TransitionChunk chunk;
    chunk.count = 1;
    chunk.payload = {bytes, words.size() * 8};
    ages_.OnChunk(chunk, kNow);
  }
  std::map<std::string, double> Report() {
    MetricsReport report(ProcessName{.role = "replay"});
    report.Begin("running");
    ages_.Report(&report);
    std::map<std::string, double> figures;
    for (size_t i = 0; i < report.message().names.size(); ++i) {
      figures[report.message().names[i]] = report.message().values[i];
    }
    return figures;
  }

  static constexpr int64_t kNow = 1000 * kSecond;
  const RecordLayout layout_{TinySpec(1)};
  FlowAges ages_{layout_, kCredits};
};

TEST_F(FlowAgesTest, LagIsTheUpdatesDoneSinceTheWeightsThatActed) {
  Ask(1, 104);  // three outstanding: update 101 begins, 100 are done
  Store(1, 90, 0);
  EXPECT_EQ(Report().at("policy_lag_p50"), 10);
  Ask(1, 50);  // sent again: nothing new
  Store(1, 100, 0);
  EXPECT_EQ(Report().at("policy_lag_p50"), 0);
}

TEST_F(FlowAgesTest, BeforeTheFirstUpdateNothingLags) {
  for (uint64_t request = 1; request <= kCredits + 1; ++request) Ask(1, request);
  Store(1, 0, 0);
  EXPECT_EQ(Report().at("policy_lag_p99"), 0);
}

TEST_F(FlowAgesTest, RandomActionsHaveNoLag) {
  Ask(1, 104);
  Store(0, 0, 2);
  EXPECT_EQ(Report().count("policy_lag_p50"), 0u);
}

TEST_F(FlowAgesTest, ALearnerThatRestartsCountsFromItsCheckpoint) {
  Ask(1, 104);
  Ask(2, 64);
  Store(1, 90, 0);  // from weights newer than the new learner's
  EXPECT_EQ(Report().at("policy_lag_p50"), 0);
  Store(1, 40, 0);
  EXPECT_EQ(Report().at("policy_lag_p50"), 20);
  Ask(1, 200);  // a late message of the old learner
  Store(2, 60, 0);
  EXPECT_EQ(Report().at("policy_lag_p50"), 0);
}

TEST_F(FlowAgesTest, StoringTakesFromTheRecordsTimeToNow) {
  Store(0, 0, 0.25);
  EXPECT_NEAR(Report().at("store_age_seconds_p50"), 0.25, 1e-6);
  EXPECT_TRUE(Report().empty()) << "each interval stands for itself";
}

TEST_F(FlowAgesTest, ARecordThatSaysItWasMadeAtNoTimeThereEverWas) {
  StoreMadeAt(0, 0, std::numeric_limits<int64_t>::min());
  EXPECT_GT(Report().at("store_age_seconds_p50"), 9e9);
}

TEST_F(FlowAgesTest, ABatchIsAsOldAsItsSteps) {
  Ring ring(TinySpec(1), {.file = {}, .capacity = 64, .run = "r"});
  std::vector<uint64_t> words(static_cast<size_t>(layout_.record_bytes()) / 8);
  auto* bytes = reinterpret_cast<uint8_t*>(words.data());
  BatchPlan plan;
  for (const int age : {8, 4}) {
    RecordHeader& header = RecordLayout::Header(bytes);
    header.time_ns = kNow - age * kSecond;
    header.kind = RecordKind::kReset;
    plan.elements.push_back({.id = ring.Append(0, 1, 0, bytes), .obs = {}, .next_obs = {}});
  }
  ages_.OnBatch(plan, ring, kNow);
  const auto figures = Report();
  EXPECT_EQ(figures.at("data_age_seconds_p50"), 4);
  EXPECT_EQ(figures.at("data_age_seconds_p99"), 8);
}

}  // namespace
}  // namespace shoal::replay
