// SPDX-License-Identifier: Apache-2.0
#include "common/dds/message_cdr.h"

#include <algorithm>
#include <cmath>

#include "common/dds/read_fields.h"

namespace shoal::dds {
namespace {

// Shoal's reports have less than a tenth of this. A reader keeps the newest report of each process.
constexpr size_t kMostFigures = 1000;
constexpr size_t kMostNameBytes = 200;

// Doubles hold integers up to here exactly, and arithmetic with such numbers does not overflow.
constexpr double kLargestSetting = 9e15;

bool IsShort(const std::string& name) { return name.size() <= kMostNameBytes; }

bool MakesSense(const MetricsMessage& message) {
  return !message.role.empty() && message.names.size() == message.values.size() &&
         message.names.size() <= kMostFigures && std::isfinite(message.time) &&
         IsShort(message.role) && IsShort(message.host) && IsShort(message.state) &&
         std::ranges::all_of(message.names, IsShort);
}

// Reads the fields of a message. False if the bytes are not a whole message.
template <class M>
bool ReadMessage(std::span<const uint8_t> cdr, M* message) {
  CdrReader reader(cdr, CdrEncoding::kDelimited2);
  reader.ReadAppendable([&] { FieldReader(&reader).ReadAll(message); });
  return reader.Finished();
}

}  // namespace

bool ParseCdr(std::span<const uint8_t> cdr, CreditsMessage* message) {
  return ReadMessage(cdr, message) &&
         std::ranges::all_of(message->credits, [](const Credit& credit) {
           return credit.replay_session > 0 && credit.session > 0;
         });
}

bool ParseCdr(std::span<const uint8_t> cdr, SampleRequest* message) {
  return ReadMessage(cdr, message) && message->learner_session > 0 && message->request > 0 &&
         message->batch > 0 && message->released < message->request &&
         message->errors.size() == message->error_ids.size() &&
         message->errors.size() <= message->batch &&
         std::ranges::all_of(message->errors,
                             [](float error) { return std::isfinite(error) && error >= 0; });
}

bool ParseCdr(std::span<const uint8_t> cdr, BatchSlot* message) {
  return ReadMessage(cdr, message) && message->learner_session > 0 && message->request > 0 &&
         message->address.pid > 0 && message->address.descriptor >= 0 &&
         message->address.token[0] != 0;
}

bool ParseCdr(std::span<const uint8_t> cdr, MetricsMessage* message) {
  return ReadMessage(cdr, message) && MakesSense(*message);
}

bool ParseCdr(std::span<const uint8_t> cdr, ReplayProgress* message) {
  return ReadMessage(cdr, message) && message->session > 0;
}

bool ParseCdr(std::span<const uint8_t> cdr, LearnerProgress* message) {
  return ReadMessage(cdr, message) && message->session > 0 &&
         message->evaluations.size() <= LearnerProgress::kMostEvaluations &&
         std::ranges::all_of(message->evaluations, [&](const EvaluationRequest& evaluation) {
           return evaluation.update <= message->updates;
         });
}

bool ParseCdr(std::span<const uint8_t> cdr, ControlMessage* message) {
  if (!ReadMessage(cdr, message)) return false;
  const bool known = message->state == RunState::kRunning ||
                     message->state == RunState::kDraining || message->state == RunState::kStopping;
  // True for every key that can change during a run: counts, ratios and shares.
  const auto possible = [](double value) { return value >= 0 && value <= kLargestSetting; };
  return known && std::isfinite(message->time) &&
         std::ranges::all_of(message->setting_values, possible) &&
         message->setting_names.size() == message->setting_values.size();
}

bool ParseCdr(std::span<const uint8_t> cdr, EvalMessage* message) {
  return ReadMessage(cdr, message) && !message->json.empty();
}

bool ParseCdr(std::span<const uint8_t> cdr, RunViewMessage* message) {
  return ReadMessage(cdr, message) && std::ranges::all_of(message->processes, MakesSense) &&
         !message->schema.empty() && std::isfinite(message->time);
}

bool ParseCdr(std::span<const uint8_t> cdr, CommandMessage* message) {
  return ReadMessage(cdr, message) && message->client > 0 && message->request > 0 &&
         !message->verb.empty();
}

bool ParseCdr(std::span<const uint8_t> cdr, ReplyMessage* message) {
  return ReadMessage(cdr, message) && message->client > 0 && message->request > 0;
}

}  // namespace shoal::dds
