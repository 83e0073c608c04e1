// SPDX-License-Identifier: Apache-2.0
// The replay server. The thread that calls Run() owns the core. service_inbox.h connects this
// thread with the link's threads, and batch_sender.h connects it with the sender's thread.
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
#include "replay_server/service/batches_in_work.h"
#include "replay_server/service/flow_ages.h"
#include "replay_server/service/gather_threads.h"
#include "replay_server/service/hub_part_writer.h"
#include "replay_server/service/learner_slots.h"
#include "replay_server/service/problem_log.h"
#include "replay_server/service/service_inbox.h"
#include "replay_server/service/service_report.h"

namespace shoal::replay {

// Members are in construction order. They are destroyed in reverse order, so that the readers'
// callbacks and the sender end before the objects that they use.
class ReplayService {
 public:
  // Makes the replay server `name` of the run in `folder`. If an earlier server left a ring, reads
  // this ring, which may take minutes. Borrows the hub. Throws Error.
  ReplayService(const std::filesystem::path& folder, const ProcessName& name, link::Hub& hub);

  // Serves until the coordinator or a signal requests a stop, or until the coordinator is lost.
  // Then writes accounting.json and returns the exit code: 0 after a stop request; 1 if the
  // coordinator was lost, after storing the records that actors still send; kUnwrittenExit if the
  // file cannot be written. Throws Error.
  int Run();

 private:
  const Config& Settings() const;
  uint64_t SpecHash() const;
  SendingWindow Window() const;
  size_t MaxChunks() const;

  // Throws Error (kUsage) because the session table is full. A restart would have the same result.
  [[noreturn]] static void RefuseMoreSessions();

  // Reports progress during the reading of a ring, which may take minutes. A process without
  // reports would be treated as hung.
  void ReportStarting();

  // One turn of the service: handles arrivals, answers requests, copies frames, sends changed
  // credits and progress.
  void Turn();

  void TellChangedCredits(SteadyTime now);

  // Sends the counts from which the coordinator computes the run's env steps.
  void TellProgress(SteadyTime now, bool at_once = false);

  void ApplySettings();

  ServiceInbox::Arrivals WaitForArrivals();

  void Take(ServiceInbox::Arrivals arrivals);
  void TakeChunk(const PooledChunk& pooled);
  void TakeRequest(const SampleRequest& request);

  // Draws the batches of all requests that can be answered now. Batches for slots are then in work.
  void Answer();

  // Answers one request. Returns false if none can be answered now.
  bool AnswerInBuffer();
  bool AnswerInSlot(SlotWriter& slots);

  // Draws a batch and writes all but its frames to `data`.
  std::optional<BegunBatch> Draw(uint8_t* data);

  // Copies a part of the frames, if parts wait. Announces the batches in slots that are complete.
  void WorkOnBatches();
  void AnnounceComplete();

  void Publish(const std::vector<Credit>& credits);

  // If replay.threads = 0, chooses the number of gather threads for the next interval from the load
  // of the last interval.
  void ChooseGatherers(SteadyTime now);

  void Report(const char* state);

  RunAccount AccountNow() const;

  // After the coordinator is lost, continues to store records until the actors stop sending.
  void DrainAfterCoordinatorLoss();

  // Returns false if accounting.json could not be written.
  bool Finish();

  const std::filesystem::path folder_;
  const ProcessName name_;
  const RunConfig run_;
  link::MetricsWriter<ReplayMetrics> metrics_publisher_;
  MetricsReport starting_report_;
  const RunAccount before_;
  ReplayCore core_;
  SessionClock session_clock_;
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
  GatherThreads gatherers_;  // after what its threads use: core, inbox, buffers and slots
  BatchesInWork in_work_;
  ServiceReport report_;
  link::Reader<ControlMessage> control_subscriber_;
  link::Reader<SampleRequest> request_subscriber_;
  link::Reader<TransitionChunk> chunk_subscriber_;

  WriteFaults faults_{[](const std::string& line) { log::Warning("{}", line); }};
  ServiceSeconds seconds_;
  SteadyTime last_turn_{}, last_credits_{}, last_chunk_{};
  SteadyTime last_choice_{};  // time of the last ChooseGatherers
  double copying_then_ = 0;   // gatherers_.seconds() at the time last_choice_
  SteadyTime last_told_{};
  std::optional<SteadyTime> progress_told_;
  uint64_t told_records_ = 0;
  bool credits_wait_ = false;  // changed credits are being collected before they are sent
};

}  // namespace shoal::replay
