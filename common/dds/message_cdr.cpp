#include "common/dds/message_cdr.h"

#include <cmath>
#include <utility>

#include "common/dds/cdr_reader.h"

namespace shoal::dds {
namespace {

CdrReader Reader(std::span<const uint8_t> cdr) { return {cdr, CdrEncoding::kDelimited2}; }

Credit ReadCredit(CdrReader* reader) {
  Credit credit;
  reader->ReadAppendable([&] {
    credit.actor = reader->Read<uint32_t>();
    credit.session = reader->Read<uint64_t>();
    credit.replay_session = reader->Read<uint64_t>();
    credit.stored = reader->Read<uint64_t>();
    credit.allowed = reader->Read<uint64_t>();
    credit.spec_hash = reader->Read<uint64_t>();
  });
  return credit;
}

MetricsMessage ReadMetrics(CdrReader* reader) {
  MetricsMessage message;
  reader->ReadAppendable([&] {
    message.role = reader->ReadString();
    message.id = reader->Read<uint32_t>();
    message.host = reader->ReadString();
    message.pid = reader->Read<int32_t>();
    message.state = reader->ReadString();
    message.time = reader->Read<double>();
    message.names = reader->ReadStrings();
    message.values = reader->ReadDoubles();
  });
  return message;
}

bool MakesSense(const MetricsMessage& message) {
  return !message.role.empty() && message.names.size() == message.values.size() &&
         std::isfinite(message.time);
}

RunEvent ReadEvent(CdrReader* reader) {
  RunEvent event;
  reader->ReadAppendable([&] {
    event.number = reader->Read<uint64_t>();
    event.time = reader->Read<double>();
    event.text = reader->ReadString();
  });
  return event;
}

}  // namespace

bool ParseCdr(std::span<const uint8_t> cdr, CreditsMessage* message) {
  CdrReader reader = Reader(cdr);
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
  CdrReader reader = Reader(cdr);
  reader.ReadAppendable([&] {
    message->spec_hash = reader.Read<uint64_t>();
    message->learner_session = reader.Read<uint64_t>();
    message->request = reader.Read<uint64_t>();
    message->after_steps = reader.Read<uint64_t>();
    message->batch = reader.Read<uint32_t>();
  });
  return reader.Finished() && message->learner_session > 0 && message->request > 0 &&
         message->batch > 0;
}

bool ParseCdr(std::span<const uint8_t> cdr, MetricsMessage* message) {
  CdrReader reader = Reader(cdr);
  *message = ReadMetrics(&reader);
  return reader.Finished() && MakesSense(*message);
}

bool ParseCdr(std::span<const uint8_t> cdr, ControlMessage* message) {
  CdrReader reader = Reader(cdr);
  reader.ReadAppendable([&] {
    message->epoch = reader.Read<uint64_t>();
    message->state = static_cast<RunState>(reader.Read<uint32_t>());
    message->time = reader.Read<double>();
    message->setting_names = reader.ReadStrings();
    message->setting_values = reader.ReadDoubles();
  });
  const bool known = message->state == RunState::kRunning ||
                     message->state == RunState::kDraining || message->state == RunState::kStopping;
  return reader.Finished() && known && std::isfinite(message->time) &&
         message->setting_names.size() == message->setting_values.size();
}

bool ParseCdr(std::span<const uint8_t> cdr, EvalMessage* message) {
  CdrReader reader = Reader(cdr);
  reader.ReadAppendable([&] {
    message->env_steps = reader.Read<uint64_t>();
    message->version.session = reader.Read<uint64_t>();
    message->version.update = reader.Read<uint64_t>();
    message->checkpoint = reader.ReadString();
    message->json = reader.ReadString();
  });
  return reader.Finished() && !message->json.empty();
}

bool ParseCdr(std::span<const uint8_t> cdr, RunViewMessage* message) {
  CdrReader reader = Reader(cdr);
  bool good = true;
  message->processes.clear();
  message->events.clear();
  reader.ReadAppendable([&] {
    message->schema = reader.ReadString();
    message->run = reader.ReadString();
    message->time = reader.Read<double>();
    message->state = reader.ReadString();
    message->env_steps = reader.Read<uint64_t>();
    message->updates = reader.Read<uint64_t>();
    reader.ReadCollection([&] {
      message->processes.push_back(ReadMetrics(&reader));
      good = good && MakesSense(message->processes.back());
    });
    reader.ReadCollection([&] { message->events.push_back(ReadEvent(&reader)); });
  });
  return reader.Finished() && good && !message->schema.empty() && std::isfinite(message->time);
}

bool ParseCdr(std::span<const uint8_t> cdr, CommandMessage* message) {
  CdrReader reader = Reader(cdr);
  reader.ReadAppendable([&] {
    message->client = reader.Read<uint64_t>();
    message->request = reader.Read<uint64_t>();
    message->verb = reader.ReadString();
    message->arguments = reader.ReadStrings();
  });
  return reader.Finished() && message->client > 0 && message->request > 0 && !message->verb.empty();
}

bool ParseCdr(std::span<const uint8_t> cdr, ReplyMessage* message) {
  CdrReader reader = Reader(cdr);
  reader.ReadAppendable([&] {
    message->client = reader.Read<uint64_t>();
    message->request = reader.Read<uint64_t>();
    message->accepted = reader.Read<uint8_t>() != 0;
    message->text = reader.ReadString();
  });
  return reader.Finished() && message->client > 0 && message->request > 0;
}

}  // namespace shoal::dds
