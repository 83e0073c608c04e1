// SPDX-License-Identifier: Apache-2.0
#include "common/spec/record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/error.h"

namespace shoal {
namespace {

ObservationSpec SmallSpec() {
  ObservationSpec spec;
  spec.task = "Tiny";
  spec.cameras = {"front"};
  spec.channels = 3;
  spec.height = 2;
  spec.width = 3;
  spec.blocks = {{"observation", 2}, {"desired_goal", 1, /*observed=*/false}};
  spec.action_size = 4;
  spec.model_fingerprint = "ab";
  return spec;
}

struct AlignedRecord {
  explicit AlignedRecord(const RecordLayout& layout)
      : words(static_cast<size_t>(layout.record_bytes()) / 8) {}
  uint8_t* data() { return reinterpret_cast<uint8_t*>(words.data()); }
  std::vector<uint64_t> words;
};

AlignedRecord ValidStep(const RecordLayout& layout) {
  AlignedRecord record(layout);
  RecordHeader& header = RecordLayout::Header(record.data());
  header.version = kRecordVersion;
  header.kind = RecordKind::kStep;
  header.index = 1;
  return record;
}

TEST(RecordLayout, PartsFollowEachOtherAndTheWholeIsPadded) {
  const RecordLayout layout(SmallSpec());
  AlignedRecord record(layout);
  EXPECT_EQ(reinterpret_cast<uint8_t*>(layout.Action(record.data()).data()), record.data() + 80);
  EXPECT_EQ(reinterpret_cast<uint8_t*>(layout.Vector(record.data()).data()), record.data() + 96);
  EXPECT_EQ(layout.Frame(record.data()).data(), record.data() + 108);
  EXPECT_EQ(layout.Frame(record.data()).size(), 18u);
  EXPECT_EQ(layout.record_bytes(), 128);
}

TEST(RecordLayout, HasTheActionAsDrawnWhereTheSpecSaysSo) {
  ObservationSpec spec = SmallSpec();
  EXPECT_TRUE(RecordLayout(spec).DrawnAction(AlignedRecord(RecordLayout(spec)).data()).empty());
  spec.drawn_actions = true;
  const RecordLayout layout(spec);
  AlignedRecord record(layout);
  EXPECT_EQ(layout.DrawnAction(record.data()).size(), 4u);
  EXPECT_EQ(reinterpret_cast<uint8_t*>(layout.DrawnAction(record.data()).data()),
            record.data() + 96);
  EXPECT_EQ(reinterpret_cast<uint8_t*>(layout.Vector(record.data()).data()), record.data() + 112);
  EXPECT_EQ(layout.prefix_bytes(), 124);
}

TEST(RecordFault, ADrawnActionMayBeAnyFiniteNumber) {
  ObservationSpec spec = SmallSpec();
  spec.drawn_actions = true;
  const RecordLayout layout(spec);
  AlignedRecord record = ValidStep(layout);
  layout.DrawnAction(record.data())[1] = -7;
  EXPECT_EQ(RecordFault(layout, record.data()), nullptr);
  layout.DrawnAction(record.data())[1] = NAN;
  EXPECT_STREQ(RecordFault(layout, record.data()), "drawn action is not finite");
}

TEST(RecordFault, AcceptsAValidRecordAndNamesEachFault) {
  const RecordLayout layout(SmallSpec());
  AlignedRecord valid = ValidStep(layout);
  EXPECT_EQ(RecordFault(layout, valid.data()), nullptr);

  const auto fault_after = [&](auto damage) {
    AlignedRecord record = valid;
    damage(RecordLayout::Header(record.data()), record.data());
    return std::string(RecordFault(layout, record.data()) ? RecordFault(layout, record.data())
                                                          : "");
  };
  using H = RecordHeader;
  EXPECT_NE(fault_after([](H& h, uint8_t*) { h.version = 9; }), "");
  EXPECT_NE(fault_after([](H& h, uint8_t*) { h.kind = RecordKind{7}; }), "");
  EXPECT_NE(fault_after([](H& h, uint8_t*) { h.index = 0; }), "");
  EXPECT_NE(fault_after([](H& h, uint8_t*) { h.kind = RecordKind::kReset; }), "");
  EXPECT_NE(fault_after([](H& h, uint8_t*) { h.kind = RecordKind::kGoal; }), "");
  EXPECT_NE(fault_after([](H& h, uint8_t*) { h.flags = 128; }), "");
  EXPECT_NE(fault_after([](H& h, uint8_t*) { h.reward = NAN; }), "");
  EXPECT_NE(fault_after([](H& h, uint8_t*) { h.log_prob = -INFINITY; }), "");
  EXPECT_NE(fault_after([&](H&, uint8_t* r) { layout.Action(r)[3] = 1.01f; }), "");
  EXPECT_NE(fault_after([&](H&, uint8_t* r) { layout.Action(r)[0] = NAN; }), "");
  EXPECT_NE(fault_after([&](H&, uint8_t* r) { layout.Vector(r)[2] = INFINITY; }), "");
}

TEST(RecordFault, AGoalRecordHasNoIndex) {
  const RecordLayout layout(SmallSpec());
  AlignedRecord record = ValidStep(layout);
  RecordHeader& header = RecordLayout::Header(record.data());
  header.kind = RecordKind::kGoal;
  header.index = 0;
  EXPECT_EQ(RecordFault(layout, record.data()), nullptr);
  header.index = 1;
  EXPECT_STREQ(RecordFault(layout, record.data()), "record index does not fit its kind");
}

TEST(ObservationSpec, AGoalPictureIsOneMoreFrameOfTheInput) {
  ObservationSpec spec = SmallSpec();
  const ObservationSpec without = spec;
  EXPECT_EQ(spec.InputChannels(), spec.stack * spec.channels);
  EXPECT_FALSE(ToJson(spec).contains("goal_picture")) << "hashes of older runs stay";
  spec.goal_picture = true;
  EXPECT_EQ(spec.InputChannels(), without.InputChannels() + spec.channels);
  EXPECT_EQ(spec.InputBytes(), without.InputBytes() + spec.FrameBytes());
}

TEST(ObservationSpec, EveryFieldChangesTheHashAndJsonKeepsThemAll) {
  const ObservationSpec spec = SmallSpec();
  EXPECT_EQ(ObservationSpecFromJson(ToJson(spec)), spec);
  const auto hash_after = [&](auto change) {
    ObservationSpec other = spec;
    change(other);
    EXPECT_EQ(ObservationSpecFromJson(ToJson(other)), other);
    return other.Hash();
  };
  using S = ObservationSpec;
  EXPECT_EQ(hash_after([](S&) {}), spec.Hash());
  EXPECT_NE(hash_after([](S& s) { s.task = "Other"; }), spec.Hash());
  EXPECT_NE(hash_after([](S& s) { s.cameras = {"side"}; }), spec.Hash());
  EXPECT_NE(hash_after([](S& s) { s.channels = 1; }), spec.Hash());
  EXPECT_NE(hash_after([](S& s) { std::swap(s.height, s.width); }), spec.Hash());
  EXPECT_NE(hash_after([](S& s) { s.stack = 2; }), spec.Hash());
  EXPECT_NE(hash_after([](S& s) { s.blocks[0].size = 3; }), spec.Hash());
  EXPECT_NE(hash_after([](S& s) { s.blocks[0].name = "x"; }), spec.Hash());
  EXPECT_NE(hash_after([](S& s) { s.blocks[1].observed = true; }), spec.Hash());
  EXPECT_NE(hash_after([](S& s) { s.drawn_actions = true; }), spec.Hash());
  EXPECT_NE(hash_after([](S& s) { s.action_size = 5; }), spec.Hash());
  EXPECT_NE(hash_after([](S& s) { s.model_fingerprint = "ac"; }), spec.Hash());
}

TEST(ObservationSpec, ObservedBlocksArePickedInRecordOrder) {
  ObservationSpec spec;
  spec.blocks = {{"a", 2}, {"b", 1}, {"hidden", 2, /*observed=*/false}, {"c", 1}};
  EXPECT_EQ(spec.VectorSize(), 4);
  EXPECT_EQ(spec.RecordedVectorSize(), 6);
  using Range = ObservationSpec::Range;
  EXPECT_EQ(spec.Recorded("c"), (Range{5, 1}));
  EXPECT_EQ(spec.Observed("c"), (Range{3, 1}));
  EXPECT_EQ(spec.Recorded("hidden"), (Range{3, 2}));
  EXPECT_FALSE(spec.Observed("hidden"));
  EXPECT_FALSE(spec.Recorded("d"));
  const std::vector<float> recorded{1, 2, 3, 4, 5, 6};
  std::vector<float> observed(4);
  BlockPicker::Observed(spec).Copy(recorded, observed);
  EXPECT_EQ(observed, (std::vector<float>{1, 2, 3, 6}));
  const std::vector<std::string> names{"c", "hidden"};
  std::vector<float> named(3);
  BlockPicker::Named(spec, names).Copy(recorded, named);
  EXPECT_EQ(named, (std::vector<float>{4, 5, 6}));
}

TEST(ObservationSpec, AMissingKeyIsNamed) {
  auto json = ToJson(SmallSpec());
  json.erase("stack");
  try {
    ObservationSpecFromJson(json);
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("stack"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace shoal
