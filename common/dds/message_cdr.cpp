// SPDX-License-Identifier: Apache-2.0
#include "common/dds/message_cdr.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/one_line.h"
#include "common/dds/cdr_reader.h"

namespace shoal::dds {
namespace {

CdrReader ReaderOf(std::span<const uint8_t> cdr) { return {cdr, CdrEncoding::kDelimited2}; }

// Text that is shown to users: one line.
std::string Text(CdrReader* reader) { return OneLine(reader->ReadString()); }

std::vector<std::string> Texts(CdrReader* reader) {
  std::vector<std::string> texts = reader->ReadStrings();
  for (std::string& text : texts) text = OneLine(text);
  return texts;
}

Credit ReadCredit(CdrReader* reader) {
  Credit credit;
  reader->ReadAppendable([&] {
    credit.actor = reader->Read<uint32_t>();
    credit.session = reader->Read<uint64_t>();
    credit.replay_session = reader->Read<uint64_t>();
    credit.stored = reader->Read<uint64_t>();
    credit.allowed = reader->Read<uint64_t>();
    credit.spec_hash = reader->Read<uint64_t>();
    credit.superseded_by = reader->Read<uint64_t>();
  });
  return credit;
}

MetricsMessage ReadMetrics(CdrReader* reader) {
  MetricsMessage message;
  reader->ReadAppendable([&] {
    message.role = Text(reader);
    message.id = reader->Read<uint32_t>();
    message.host = Text(reader);
    message.pid = reader->Read<int32_t>();
    message.state = Text(reader);
    message.time = reader->Read<double>();
    message.names = Texts(reader);
    message.values = reader->ReadDoubles();
  });
  return message;
}

// No report of ours has a tenth of it; a reader keeps the newest of each process.
constexpr size_t kMostFigures = 1000;
constexpr size_t kMostNameBytes = 200;

// Doubles hold integers up to here exactly; arithmetic with it does not overflow.
constexpr double kLargestSetting = 9e15;

bool IsShort(const std::string& name) { return name.size() <= kMostNameBytes; }

bool MakesSense(const MetricsMessage& message) {
  return !message.role.empty() && message.names.size() == message.values.size() &&
         message.names.size() <= kMostFigures && std::isfinite(message.time) &&
         IsShort(message.role) && IsShort(message.host) && IsShort(message.state) &&
         std::ranges::all_of(message.names, IsShort);
}

EvaluationRequest ReadEvaluation(CdrReader* reader) {
  EvaluationRequest evaluation;
  reader->ReadAppendable([&] {
    evaluation.update = reader->Read<uint64_t>();
    evaluation.env_steps = reader->Read<uint64_t>();
    evaluation.checkpoint = Text(reader);
  });
  return evaluation;
}

RunEvent ReadEvent(CdrReader* reader) {
  RunEvent event;
  reader->ReadAppendable([&] {
    event.number = reader->Read<uint64_t>();
    event.time = reader->Read<double>();
    event.text = Text(reader);
  });
  return event;
}

}  // namespace

bool ParseCdr(std::span<const uint8_t> cdr, CreditsMessage* message) {
  CdrReader reader = ReaderOf(cdr);
  bool good = true;
  message->credits.clear();
  reader.ReadAppendable([&] {
    reader.ReadCollection([&] {
      const Credit credit = ReadCredit(&reader);
      good = good && credit.replay_session > 0 && credit.session > 0;
      message->credits.push_back(credit);
    });
  });
  return reader.Finished() && good;
}

bool ParseCdr(std::span<const uint8_t> cdr, SampleRequest* message) {
  CdrReader reader = ReaderOf(cdr);
  reader.ReadAppendable([&] {
    message->spec_hash = reader.Read<uint64_t>();
    message->learner_session = reader.Read<uint64_t>();
    message->request = reader.Read<uint64_t>();
    message->after_steps = reader.Read<uint64_t>();
    message->batch = reader.Read<uint32_t>();
    message->schema_hash = reader.Read<uint64_t>();
    message->released = reader.Read<uint64_t>();
    message->takes_slots = reader.Read<uint8_t>() != 0;
    message->refused_token = reader.Read<uint64_t>();
  });
  return reader.Finished() && message->learner_session > 0 && message->request > 0 &&
         message->batch > 0 && message->released < message->request;
}

bool ParseCdr(std::span<const uint8_t> cdr, BatchSlot* message) {
  CdrReader reader = ReaderOf(cdr);
  reader.ReadAppendable([&] {
    message->spec_hash = reader.Read<uint64_t>();
    message->learner_session = reader.Read<uint64_t>();
    message->request = reader.Read<uint64_t>();
    message->stored_records = reader.Read<uint64_t>();
    message->stored_steps = reader.Read<uint64_t>();
    message->unsampleable_steps = reader.Read<uint64_t>();
    message->address.pid = reader.Read<int32_t>();
    message->address.descriptor = reader.Read<int32_t>();
    message->address.token[0] = reader.Read<uint64_t>();
    message->address.token[1] = reader.Read<uint64_t>();
    message->address.bytes = reader.Read<uint64_t>();
    message->slot = reader.Read<uint32_t>();
  });
  return reader.Finished() && message->learner_session > 0 && message->request > 0 &&
         message->address.pid > 0 && message->address.descriptor >= 0 &&
         message->address.token[0] != 0;
}

bool ParseCdr(std::span<const uint8_t> cdr, MetricsMessage* message) {
  CdrReader reader = ReaderOf(cdr);
  *message = ReadMetrics(&reader);
  return reader.Finished() && MakesSense(*message);
}

bool ParseCdr(std::span<const uint8_t> cdr, ReplayProgress* message) {
  CdrReader reader = ReaderOf(cdr);
  reader.ReadAppendable([&] {
    message->replay = reader.Read<uint32_t>();
    message->session = reader.Read<uint64_t>();
    message->stored_steps = reader.Read<uint64_t>();
    message->stored_records = reader.Read<uint64_t>();
  });
  return reader.Finished() && message->session > 0;
}

bool ParseCdr(std::span<const uint8_t> cdr, LearnerProgress* message) {
  CdrReader reader = ReaderOf(cdr);
  message->evaluations.clear();
  reader.ReadAppendable([&] {
    message->session = reader.Read<uint64_t>();
    message->updates = reader.Read<uint64_t>();
    message->env_steps = reader.Read<uint64_t>();
    message->drained = reader.Read<uint8_t>() != 0;
    reader.ReadCollection([&] { message->evaluations.push_back(ReadEvaluation(&reader)); });
  });
  return reader.Finished() && message->session > 0 &&
         message->evaluations.size() <= LearnerProgress::kMostEvaluations &&
         std::ranges::all_of(message->evaluations, [&](const EvaluationRequest& evaluation) {
           return evaluation.update <= message->updates;
         });
}

bool ParseCdr(std::span<const uint8_t> cdr, ControlMessage* message) {
  CdrReader reader = ReaderOf(cdr);
  reader.ReadAppendable([&] {
    message->epoch = reader.Read<uint64_t>();
    message->state = static_cast<RunState>(reader.Read<uint32_t>());
    message->time = reader.Read<double>();
    message->setting_names = Texts(&reader);
    message->setting_values = reader.ReadDoubles();
  });
  const bool known = message->state == RunState::kRunning ||
                     message->state == RunState::kDraining || message->state == RunState::kStopping;
  // Holds for every key that changes while a run goes on: counts, ratios and shares.
  const auto possible = [](double value) { return value >= 0 && value <= kLargestSetting; };
  return reader.Finished() && known && std::isfinite(message->time) &&
         std::ranges::all_of(message->setting_values, possible) &&
         message->setting_names.size() == message->setting_values.size();
}

bool ParseCdr(std::span<const uint8_t> cdr, EvalMessage* message) {
  CdrReader reader = ReaderOf(cdr);
  reader.ReadAppendable([&] {
    message->env_steps = reader.Read<uint64_t>();
    message->version.session = reader.Read<uint64_t>();
    message->version.update = reader.Read<uint64_t>();
    message->checkpoint = Text(&reader);
    message->json = reader.ReadString();
  });
  return reader.Finished() && !message->json.empty();
}

bool ParseCdr(std::span<const uint8_t> cdr, RunViewMessage* message) {
  CdrReader reader = ReaderOf(cdr);
  bool good = true;
  message->processes.clear();
  message->events.clear();
  reader.ReadAppendable([&] {
    message->schema = Text(&reader);
    message->run = Text(&reader);
    message->time = reader.Read<double>();
    message->state = Text(&reader);
    message->env_steps = reader.Read<uint64_t>();
    message->updates = reader.Read<uint64_t>();
    reader.ReadCollection([&] {
      message->processes.push_back(ReadMetrics(&reader));
      good = good && MakesSense(message->processes.back());
    });
    reader.ReadCollection([&] { message->events.push_back(ReadEvent(&reader)); });
    message->trouble = Text(&reader);
  });
  return reader.Finished() && good && !message->schema.empty() && std::isfinite(message->time);
}

bool ParseCdr(std::span<const uint8_t> cdr, CommandMessage* message) {
  CdrReader reader = ReaderOf(cdr);
  reader.ReadAppendable([&] {
    message->client = reader.Read<uint64_t>();
    message->request = reader.Read<uint64_t>();
    message->verb = Text(&reader);
    message->arguments = Texts(&reader);
  });
  return reader.Finished() && message->client > 0 && message->request > 0 && !message->verb.empty();
}

bool ParseCdr(std::span<const uint8_t> cdr, ReplyMessage* message) {
  CdrReader reader = ReaderOf(cdr);
  reader.ReadAppendable([&] {
    message->client = reader.Read<uint64_t>();
    message->request = reader.Read<uint64_t>();
    message->accepted = reader.Read<uint8_t>() != 0;
    message->text = Text(&reader);
    message->key = Text(&reader);
    message->from = reader.Read<double>();
    message->to = reader.Read<double>();
  });
  return reader.Finished() && message->client > 0 && message->request > 0;
}

}  // namespace shoal::dds
