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
  spec.blocks = {{"observation", 2}, {"desired_goal", 1}};
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
  EXPECT_NE(fault_after([](H& h, uint8_t*) { h.flags = 128; }), "");
  EXPECT_NE(fault_after([](H& h, uint8_t*) { h.reward = NAN; }), "");
  EXPECT_NE(fault_after([&](H&, uint8_t* r) { layout.Action(r)[3] = 1.01f; }), "");
  EXPECT_NE(fault_after([&](H&, uint8_t* r) { layout.Action(r)[0] = NAN; }), "");
  EXPECT_NE(fault_after([&](H&, uint8_t* r) { layout.Vector(r)[2] = INFINITY; }), "");
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
  EXPECT_NE(hash_after([](S& s) { s.action_size = 5; }), spec.Hash());
  EXPECT_NE(hash_after([](S& s) { s.model_fingerprint = "ac"; }), spec.Hash());
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
