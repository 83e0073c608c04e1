// SPDX-License-Identifier: Apache-2.0
// The replay server: the core, owned by the thread that calls Run(), between the link's threads
// (service_inbox.h) and the batch sender's thread (batch_sender.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "common/base/clock.h"
#include "common/base/log.h"
#include "common/base/write_faults.h"
#include "common/config/run_config.h"
#include "common/config/sending_window.h"
#include "common/intake/session_clock.h"
#include "common/link/hub.h"
#include "common/link/metrics_writer.h"
#include "common/link/reader.h"
#include "common/link/writer.h"
#include "common/run_folder/accounting_file.h"
#include "common/wire/control_state.h"
#include "common/wire/metrics_report.h"
#include "common/wire/process_name.h"
#include "replay_server/core/replay_core.h"
#include "replay_server/service/batch_sender.h"
#include "replay_server/service/flow_ages.h"
#include "replay_server/service/gather_threads.h"
#include "replay_server/service/hub_part_writer.h"
#include "replay_server/service/learner_slots.h"
#include "replay_server/service/problem_log.h"
#include "replay_server/service/service_inbox.h"
#include "replay_server/service/service_report.h"

namespace shoal::replay {

// Members are in construction order; destruction, the reverse, ends the readers' callbacks and the
// sender before what they use.
class ReplayService {
 public:
  // The replay server `name` of the run in `folder`. Takes over from a former one: reads its ring,
  // which can take minutes. Borrows the hub. Throws Error.
  ReplayService(const std::filesystem::path& folder, const ProcessName& name, link::Hub& hub);

  // Serves until the coordinator says stop (0), a stop is requested (0), or the coordinator is gone
  // (1: what the actors still send is stored first). Leaves accounting.json; kUnwrittenExit where
  // that could not be written. Throws Error.
  int Run();

 private:
  const Config& Settings() const;
  uint64_t SpecHash() const;
  SendingWindow Window() const;
  size_t MaxChunks() const;

  // A restart would find the same full table.
  [[noreturn]] static void RefuseMoreSessions();

  // Reading a cold ring takes minutes, in which a process that says nothing would be taken for
  // hung.
  void ReportStarting();

  // One turn of the service: takes what came, answers one request, tells what has changed.
  void Turn();

  void TellChangedCredits(SteadyTime now);

  // Sends the counts by which the coordinator knows the run's env steps.
  void TellProgress(SteadyTime now, bool at_once = false);

  void ApplySettings();

  ServiceInbox::Arrivals WaitForArrivals(SteadyTime deadline);

  void Take(ServiceInbox::Arrivals arrivals);

  void AnswerOne();

  bool AnswerInBuffer();

  bool AnswerInSlot(SlotWriter& slots);

  std::optional<DrawnBatch> Draw(uint8_t* data);

  void Publish(const std::vector<Credit>& credits);

  // replay.threads = 0: for the next second as many as the last one asked for.
  void ChooseGatherers(SteadyTime now);

  void Report(const char* state);

  RunAccount AccountNow() const;

  // Keeps storing after the coordinator is lost, until the actors, which notice it too, go quiet.
  void DrainAfterCoordinatorLoss();

  // False when the account could not be written.
  bool Finish();

  const std::filesystem::path folder_;
  const ProcessName name_;
  const RunConfig run_;
  link::MetricsWriter<ReplayMetrics> metrics_publisher_;
  MetricsReport starting_report_;
  const RunAccount before_;
  ReplayCore core_;
  SessionClock session_clock_;
  GatherThreads gatherers_;
  const int most_gatherers_;
  ControlState control_;
  ServiceInbox inbox_;
  ProblemLog problems_;
  FlowAges ages_;
  link::Writer<CreditsMessage> credit_publisher_;
  link::Writer<ReplayProgress> progress_publisher_;
  HubPartWriter part_writer_;
  BatchSender sender_;
  LearnerSlots slots_;
  ServiceReport report_;
  link::Reader<ControlMessage> control_subscriber_;
  link::Reader<SampleRequest> request_subscriber_;
  link::Reader<TransitionChunk> chunk_subscriber_;

  WriteFaults faults_{[](const std::string& line) { log::Warning("{}", line); }};
  ServiceSeconds seconds_;
  SteadyTime last_turn_{}, last_credits_{}, last_chunk_{};
  SteadyTime last_choice_{};  // of gatherers
  double sampling_then_ = 0;  // seconds_.sampling at that time
  SteadyTime last_told_{};
  std::optional<SteadyTime> progress_told_;
  uint64_t told_records_ = 0;
  bool credits_wait_ = false;  // words about credit are being collected
  bool answered_ = false;      // a batch in the last turn: there may be another one to draw
};

}  // namespace shoal::replay
