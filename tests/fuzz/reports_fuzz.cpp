// SPDX-License-Identifier: Apache-2.0
// Messages other than bulk messages: any bytes are either refused or decoded within their bounds,
// and receivers accept any decoded content. First byte: the kind of message; the rest is serialised
// CDR.
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "actor/sending/chunk_window.h"
#include "actor/sending/credit_inbox.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/dds/message_cdr.h"
#include "common/wire/control_state.h"
#include "launch/record/evaluations.h"
#include "launch/record/metrics_log.h"
#include "launch/run/command_handler.h"
#include "launch/run/run_progress.h"
#include "launch/watch/bottleneck.h"
#include "launch/watch/prometheus_families.h"
#include "launch/watch/run_figures.h"
#include "launch/watch/top_table.h"
#include "learner/slot_batches.h"
#include "replay_server/core/replay_core.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/replay_server/record_script.h"

namespace shoal {
namespace {

// A message with an address is received by a receiver of that address.
void Use(const CreditsMessage& message) {
  for (const Credit& credit : message.credits) {
    actor::CreditInbox inbox(credit.actor, credit.session);
    inbox.OnMessage(message);
    const auto newest = inbox.Take(Now());
    CHECK(newest.has_value());
    actor::ChunkWindow window({.spec_hash = credit.spec_hash,
                               .actor = credit.actor,
                               .session = credit.session,
                               .record_bytes = 8,
                               .chunk_records = 4,
                               .chunks = 3,
                               .first_records = 2});
    for (uint64_t sequence = 1; sequence <= 2; ++sequence) {
      window.BeginRecord();
      window.EndRecord(sequence);
    }
    window.Flush();
    for (const Credit& word : message.credits) window.OnCredit(word);
    while (window.NextToSend()) window.MarkSent();
    CHECK(window.stored() <= 2);
    window.Rewind();
  }
}

void Use(const SampleRequest& message) {
  const RunConfig run = replay::TinyRun(1, 64);
  replay::ReplayCore core(run, "", 1);
  core.TakeRequest(message);
  SampleRequest ours = message;
  ours.spec_hash = run.spec.Hash();
  ours.schema_hash = core.batch_schema().Hash();
  core.TakeRequest(ours);
  CHECK(ours.errors.size() == ours.error_ids.size());
}

// The message names this process, whose open memory has no slots.
void Use(const BatchSlot& message) {
  BatchSlot ours = message;
  ours.address.pid = getpid();
  learner::SlotBatches batches(message.learner_session, 64);
  CHECK(batches.Add(ours) == learner::SlotBatches::Verdict::kTaken);
  try {
    batches.Open(ours.request);
    CHECK(false) << "opened";
  } catch (const Error& e) {
    fuzz::CheckOneLine(e.what());
  }
  CHECK(batches.Refuse(ours.request).size() == 1);
}

void Use(const MetricsMessage& message) {
  launch::MetricsView view;
  const SteadyTime now = Now();
  view.OnMessage(message, now);
  MetricsMessage next = message;
  for (double& value : next.values) value += 1;
  view.OnMessage(next, now);
  launch::CollectFigures(view, now);
  launch::FormatBottleneck(
      launch::FindBottleneck(launch::TotalsOf(view), {.usable_cores = 2, .actors = 2}));
  CHECK(view.Reports(now).size() == 1);
  const std::filesystem::path file = fuzz::Scratch() / "metrics.jsonl";
  fuzz::WriteScratch(file, "");
  launch::MetricsLog log(file, {});
  log.Write(message);
  log.Flush();
  const std::string line = ReadFile(file);
  CHECK(line.ends_with('\n'));
  CHECK(nlohmann::json::parse(line).at("role").is_string());
}

void Use(const ReplayProgress& message) {
  launch::RunProgress progress;
  progress.OnReplay(message);
  CHECK(progress.stored_steps() == message.stored_steps);
}

void Use(const LearnerProgress& message) {
  launch::RunProgress progress;
  progress.OnLearner(message);
  CHECK(progress.updates() == message.updates);
}

void Use(const ControlMessage& message) {
  ControlState state{Now()};
  state.OnMessage(message, Now());
  for (const launch::LiveKey& key : launch::LiveKeys()) state.SettingOr(key.key, 0);
}

void Use(const EvalMessage& message) {
  try {
    launch::ParseEvaluation(message.json, "evaluation");
  } catch (const Error& e) {
    fuzz::CheckOneLine(e.what());
  }
}

void Use(const RunViewMessage& message) {
  for (const int width : {0, 20, 80}) {
    for (int column = 0; column < launch::TopColumns(); ++column) {
      for (const std::string& line : launch::FormatTop(message, {.column = column}, width)) {
        fuzz::CheckOneLine(line + ".");
      }
    }
  }
  fuzz::CheckOneLine(launch::FormatTopLine(message));
  CHECK(nlohmann::json::parse(launch::TopJson(message)).is_object());
  launch::PrometheusFamilies(message);
  launch::FiguresOfView(message, Now());
}

void Use(const CommandMessage& message) {
  launch::LiveSettings settings{Config()};
  launch::CommandHandler handler(settings, {.running = [] { return true; },
                                            .env_steps = [] { return uint64_t{0}; },
                                            .stop = [] {},
                                            .scale = [](int, int) {},
                                            .note = [](const launch::SettingChange&) {},
                                            .check = [](const Config&) {}});
  const ReplyMessage reply = handler.Handle(message);
  CHECK(reply.client == message.client && reply.request == message.request);
  fuzz::CheckOneLine(reply.text);
}

void Use(const ReplyMessage&) {}

template <class M>
void Run(const std::string& body) {
  std::vector<uint8_t> cdr{0, 9, 0, 0};
  cdr.insert(cdr.end(), body.begin(), body.end());
  M message;
  if (dds::ParseCdr(cdr, &message)) Use(message);
}

using MessageReader = void (*)(const std::string& body);
constexpr MessageReader kMessages[] = {
    Run<CreditsMessage>, Run<SampleRequest>,   Run<MetricsMessage>, Run<ControlMessage>,
    Run<EvalMessage>,    Run<RunViewMessage>,  Run<CommandMessage>, Run<ReplyMessage>,
    Run<ReplayProgress>, Run<LearnerProgress>, Run<BatchSlot>};

}  // namespace
}  // namespace shoal

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  shoal::kMessages[data[0] % std::size(shoal::kMessages)](shoal::fuzz::Text(data + 1, size - 1));
  return 0;
}
