// SPDX-License-Identifier: Apache-2.0
#include "common/dds/message_cdr.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <string>

#include "tests/common/dds/encode_cdr.h"
#include "tests/common/link/example_messages.h"
#include "tests/common/link/message_text.h"

namespace shoal::dds {
namespace {

using Bytes = std::vector<uint8_t>;

template <class M>
bool IsTaken(const M& message) {
  M back;
  return ParseCdr(EncodeCdr(message), &back);
}

ActorMetrics ValidMetrics() {
  ActorMetrics message;
  message.role = "actor";
  message.time = 5;
  message.names = {"a", "b"};
  message.values = {1, 2};
  return message;
}

// Overwrites the number at `offset`.
void Set(Bytes* cdr, size_t offset, uint32_t value) {
  std::memcpy(cdr->data() + offset, &value, sizeof value);
}

// Makes the outermost struct smaller or larger by whole bytes at its end.
void Resize(Bytes* cdr, size_t body_bytes) {
  cdr->resize(8 + body_bytes);
  Set(cdr, 4, static_cast<uint32_t>(body_bytes));
}

template <class M>
class EveryMessage : public testing::Test {
 protected:
  EveryMessage() { Fill(41, &message_); }
  M message_{};
};
using Messages = testing::Types<CreditsMessage, SampleRequest, BatchSlot, ActorMetrics,
                                ReplayProgress, LearnerProgress, ControlMessage, EvalMessage,
                                RunViewMessage, CommandMessage, ReplyMessage>;
TYPED_TEST_SUITE(EveryMessage, Messages);

TYPED_TEST(EveryMessage, IsReadAsCycloneWroteIt) {
  TypeParam back;
  ASSERT_TRUE(ParseCdr(EncodeCdr(this->message_), &back));
  EXPECT_EQ(Describe(back), Describe(this->message_));
}

TYPED_TEST(EveryMessage, IsRefusedWhenItIsCutShort) {
  const Bytes whole = EncodeCdr(this->message_);
  for (size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    TypeParam back;
    EXPECT_FALSE(ParseCdr(cut, &back)) << size << " of " << whole.size() << " bytes";
  }
}

// The message read from `cdr` between bytes of `neighbour`.
template <class M>
std::string ReadAmong(uint8_t neighbour, const Bytes& cdr) {
  constexpr size_t kMargin = 64;
  Bytes memory(cdr.size() + 2 * kMargin, neighbour);
  std::ranges::copy(cdr, memory.begin() + kMargin);
  M back{};
  const bool taken = ParseCdr(std::span(memory).subspan(kMargin, cdr.size()), &back);
  return taken ? Describe(back) : "refused";
}

// Also with sizes that fit, so that fields at the end are absent or cut. The result must depend on
// the bytes only.
TYPED_TEST(EveryMessage, CanHaveAnyNumberAnywhere) {
  const auto expect_own_bytes_alone = [](const Bytes& cdr, const std::string& what) {
    ASSERT_EQ(ReadAmong<TypeParam>(0x00, cdr), ReadAmong<TypeParam>(0xff, cdr)) << what;
    TypeParam back;
    ParseCdr(cdr, &back);  // without neighbours: AddressSanitizer watches
  };
  const Bytes whole = EncodeCdr(this->message_);
  for (size_t body = 0; body < whole.size() - 8; ++body) {
    Bytes cut = whole;
    Resize(&cut, body);
    expect_own_bytes_alone(cut, fmt::format("{} bytes", body));
  }
  for (size_t offset = 4; offset + 4 <= whole.size(); ++offset) {
    for (const uint32_t value : {0u, 1u, 3u, 0x20000000u, 0x7fffffffu, 0xffffffffu}) {
      Bytes altered = whole;
      Set(&altered, offset, value);
      expect_own_bytes_alone(altered, fmt::format("{} at byte {}", value, offset));
    }
  }
}

TYPED_TEST(EveryMessage, OfAnotherEncodingIsRefused) {
  for (const char encoding : "\x00\x01\x06\x08\x0a") {
    Bytes cdr = EncodeCdr(this->message_);
    cdr[1] = static_cast<uint8_t>(encoding);
    TypeParam back;
    EXPECT_FALSE(ParseCdr(cdr, &back)) << int{encoding};
  }
}

TYPED_TEST(EveryMessage, OfANewerSenderHasItsNewFieldsSkipped) {
  Bytes cdr = EncodeCdr(this->message_);
  Resize(&cdr, cdr.size() - 8 + 12);
  TypeParam back;
  ASSERT_TRUE(ParseCdr(cdr, &back));
  EXPECT_EQ(Describe(back), Describe(this->message_));
}

TEST(MessageCdr, WhatAnOlderSenderLeftOutAtTheEndIsEmpty) {
  ReplyMessage reply;
  Fill(1, &reply);
  Bytes cdr = EncodeCdr(reply);
  Resize(&cdr, 8 + 8 + 1);  // client, request, accepted
  ReplyMessage back;
  ASSERT_TRUE(ParseCdr(cdr, &back));
  EXPECT_EQ(back.text, "");
  EXPECT_EQ(back.request, reply.request);
  EXPECT_TRUE(back.accepted);
}

TEST(MessageCdr, TextsHoldNothingThatATerminalWouldObey) {
  ReplyMessage reply;
  Fill(1, &reply);
  reply.text = "two\nlines\x1b[2J";
  ReplyMessage back;
  ASSERT_TRUE(ParseCdr(EncodeCdr(reply), &back));
  EXPECT_EQ(back.text, "two lines?[2J");
}

// Cyclone 0.10.2 accepts this message: it asks for four bytes per number where eight are read.
TEST(MessageCdr, NumbersOfWhichOnlyHalfIsThereAreRefused) {
  Bytes cdr = EncodeCdr(ValidMetrics());
  Resize(&cdr, cdr.size() - 8 - 8);
  ActorMetrics back;
  EXPECT_FALSE(ParseCdr(cdr, &back));
}

TEST(MessageCdr, MetricsNeedARoleATimeAndAValuePerName) {
  EXPECT_TRUE(IsTaken(ValidMetrics()));
  ActorMetrics message = ValidMetrics();
  message.values.pop_back();
  EXPECT_FALSE(IsTaken(message));
  message = ValidMetrics();
  message.role = "";
  EXPECT_FALSE(IsTaken(message));
  message = ValidMetrics();
  message.time = NAN;
  EXPECT_FALSE(IsTaken(message));
  message = ValidMetrics();
  message.values[1] = NAN;  // a figure without meaning yet, such as a mean of nothing
  EXPECT_TRUE(IsTaken(message));
}

TEST(MessageCdr, ReportsAreOfASizeThatAReportCanHave) {
  ActorMetrics message = ValidMetrics();
  message.names.assign(1000, "a");
  message.values.assign(1000, 1);
  EXPECT_TRUE(IsTaken(message));
  message.names.assign(1001, "a");
  message.values.assign(1001, 1);
  EXPECT_FALSE(IsTaken(message));
  message = ValidMetrics();
  message.names[0] = std::string(201, 'a');
  EXPECT_FALSE(IsTaken(message));
  message = ValidMetrics();
  message.state = std::string(20'000'000, 'a');
  EXPECT_FALSE(IsTaken(message));
}

TEST(MessageCdr, ProgressIsOfASessionAndItsEvaluationsAreOfUpdatesThatWereDone) {
  EXPECT_TRUE(IsTaken(ReplayProgress{.session = 1}));
  EXPECT_FALSE(IsTaken(ReplayProgress{.session = 0}));
  LearnerProgress progress{.session = 1, .updates = 5};
  progress.evaluations = {{.update = 5, .env_steps = 1, .checkpoint = "a"}};
  EXPECT_TRUE(IsTaken(progress));
  progress.evaluations[0].update = 6;
  EXPECT_FALSE(IsTaken(progress));
  progress.evaluations.assign(LearnerProgress::kMostEvaluations + 1, {});
  EXPECT_FALSE(IsTaken(progress));
}

TEST(MessageCdr, ChangedSettingsAreNumbersThatAKeyCanHave) {
  ControlMessage message{.epoch = 1, .state = RunState::kRunning, .time = 1};
  message.setting_names = {"replay.samples_per_insert"};
  for (const double value : {double{NAN}, double{INFINITY}, -5.0, 1e300}) {
    message.setting_values = {value};
    EXPECT_FALSE(IsTaken(message)) << value;
  }
  for (const double value : {0.0, 0.5, 1e12}) {
    message.setting_values = {value};
    EXPECT_TRUE(IsTaken(message)) << value;
  }
}

TEST(MessageCdr, ControlStatesAreTheThreeThatExist) {
  EXPECT_TRUE(IsTaken(ControlMessage{.epoch = 1, .state = RunState::kRunning, .time = 1}));
  EXPECT_TRUE(IsTaken(ControlMessage{.epoch = 1, .state = RunState::kStopping, .time = 1}));
  EXPECT_FALSE(IsTaken(ControlMessage{.epoch = 1, .state = RunState{0}, .time = 1}));
  EXPECT_FALSE(IsTaken(ControlMessage{.epoch = 1, .state = RunState{4}, .time = 1}));
  EXPECT_FALSE(IsTaken(ControlMessage{.epoch = 1, .state = RunState::kRunning, .time = INFINITY}));
}

TEST(MessageCdr, SessionsAndRequestsStartAtOne) {
  CreditsMessage credits;
  EXPECT_TRUE(IsTaken(credits));
  credits.credits = {{.replay_session = 1, .session = 2}, {.replay_session = 1, .session = 3}};
  EXPECT_TRUE(IsTaken(credits));
  credits.credits[1].session = 0;
  EXPECT_FALSE(IsTaken(credits));
  SampleRequest request;
  request.learner_session = 1;
  request.request = 1;
  request.batch = 1;
  EXPECT_TRUE(IsTaken(request));
  request.request = 0;
  EXPECT_FALSE(IsTaken(request));
  request.request = 1;
  request.batch = 0;
  EXPECT_FALSE(IsTaken(request));
}

TEST(MessageCdr, ARequestReleasesOnlyWhatCameBeforeIt) {
  SampleRequest request{.learner_session = 1, .request = 5, .batch = 1, .released = 4};
  EXPECT_TRUE(IsTaken(request));
  request.released = 5;
  EXPECT_FALSE(IsTaken(request));
}

TEST(MessageCdr, ARequestBringsAnErrorPerSampleAndNoMoreThanABatchHas) {
  SampleRequest request{.learner_session = 1, .request = 5, .batch = 2};
  request.error_ids = {7, 8};
  request.errors = {0, 2.5f};
  EXPECT_TRUE(IsTaken(request));
  for (const float error : {-0.5f, NAN, INFINITY}) {
    request.errors[1] = error;
    EXPECT_FALSE(IsTaken(request)) << error;
  }
  request.errors = {1};
  EXPECT_FALSE(IsTaken(request));
  request.errors = {1, 2};
  request.batch = 1;
  EXPECT_FALSE(IsTaken(request));
}

TEST(MessageCdr, AnOlderLearnersRequestBringsNoErrors) {
  SampleRequest request;
  Fill(41, &request);
  request.error_ids.clear();
  request.errors.clear();
  Bytes cdr = EncodeCdr(request);
  Resize(&cdr, cdr.size() - 8 - 8);  // without the two empty lists
  SampleRequest back;
  ASSERT_TRUE(ParseCdr(cdr, &back));
  EXPECT_EQ(Describe(back), Describe(request));
}

TEST(MessageCdr, ARequestsErrorsHaveTheseBytes) {
  SampleRequest request{.spec_hash = 1, .learner_session = 2, .request = 3, .batch = 4};
  request.error_ids = {0x0102030405060708, 9};
  request.errors = {1, 0.5f};
  const Bytes cdr = EncodeCdr(request);
  const Bytes expected{2, 0, 0, 0,                                              // ids
                       8, 7, 6, 5, 4, 3, 2,    1,    9, 0, 0, 0,   0, 0, 0, 0,  //
                       2, 0, 0, 0, 0, 0, 0x80, 0x3f, 0, 0, 0, 0x3f};            // errors
  ASSERT_GT(cdr.size(), expected.size());
  EXPECT_EQ(Bytes(cdr.end() - static_cast<std::ptrdiff_t>(expected.size()), cdr.end()), expected);
}

TEST(MessageCdr, ASlotLiesInADescriptorOfAProcessAndHasAToken) {
  BatchSlot slot;
  Fill(3, &slot);
  EXPECT_TRUE(IsTaken(slot));
  slot.address.descriptor = -1;
  EXPECT_FALSE(IsTaken(slot));
  slot.address.descriptor = 3;
  slot.address.pid = 0;
  EXPECT_FALSE(IsTaken(slot));
  slot.address.pid = 3;
  slot.address.token[0] = 0;  // would mean no token
  EXPECT_FALSE(IsTaken(slot));
}

}  // namespace
}  // namespace shoal::dds
