// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/batch_handover.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <optional>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/config/batch_options.h"
#include "common/dds/bus.h"
#include "common/link/reader.h"
#include "common/link/writer.h"
#include "common/wire/metrics_report.h"
#include "learner/batch_feed.h"
#include "replay_server/core/request_queue.h"
#include "replay_server/service/batch_sender.h"
#include "replay_server/service/hub_part_writer.h"
#include "replay_server/service/learner_slots.h"
#include "replay_server/service/service_inbox.h"
#include "tests/benchmark/forked_processes.h"

namespace shoal::bench {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kWarmUp = 20;
constexpr uint64_t kLearnerSession = 1;
constexpr seconds kDeadline{120};

RunConfig RunOf(int batch) {
  RunConfig run = TwoCameraRun("handover");
  run.config.learner.batch = batch;
  return run;
}

// The replay server without a ring: every request can be answered.
class EmptyReplay {
 public:
  EmptyReplay(const RunConfig& run, const ClusterAddress& address, bool shared)
      : bytes_(BatchSchemaOf(run).total_bytes()),
        bus_(address, run.config.transport, dds::Role::kReplay),
        inbox_(run.spec.Hash(), 64, 1),
        queue_(run.spec.Hash(), BatchSchemaOf(run).Hash(), run.config.learner.request_credits),
        writer_(bus_),
        sender_(run.spec.Hash(), bytes_, 2, &writer_, [this] { inbox_.Wake(); }),
        slots_(run.spec.Hash(), bytes_,
               static_cast<uint32_t>(run.config.learner.request_credits) + 1,
               [=] {
                 return replay::MemoryRoom{shared ? ~uint64_t{0} : 0, "asked for"};
               }),
        requests_(bus_, [this](const SampleRequest& request) { inbox_.OnRequest(request); }) {}

  // CPU seconds between the answers to the two requests.
  double Serve(uint64_t from, uint64_t to) {
    double start = 0;
    const SteadyTime deadline = Now() + kDeadline;
    while (Now() < deadline) {
      for (const SampleRequest& request : inbox_.Wait(Now() + milliseconds(100)).requests) {
        queue_.Offer(request);
        slots_.OnRequest(request);
        sender_.SetLearnerSession(request.learner_session);
      }
      while (const auto request = Answer()) {
        if (*request == from) start = CpuSeconds();
        if (*request == to) return CpuSeconds() - start;
      }
    }
    throw RuntimeError("the learner asks no more");
  }

 private:
  std::optional<uint64_t> Answer() {
    const auto request = queue_.Next(0);
    if (!request) return std::nullopt;
    if (SlotWriter* slots = slots_.writer()) {
      const auto held = slots->Held(request->request);
      if (!held && slots->FreeSlot() == nullptr) return std::nullopt;
      sender_.Send(held ? *held : slots->Fill(request->request, 1, 1));
    } else {
      uint8_t* buffer = sender_.FreeBuffer();
      if (buffer == nullptr) return std::nullopt;
      sender_.Send({*request, 1, 1}, buffer);
    }
    queue_.Pop();
    return request->request;
  }

  const uint64_t bytes_;
  dds::Bus bus_;
  replay::ServiceInbox inbox_;
  replay::RequestQueue queue_;
  replay::HubPartWriter writer_;
  replay::BatchSender sender_;
  replay::LearnerSlots slots_;
  link::Reader<SampleRequest> requests_;
};

uint64_t LookAt(const BatchView& batch, uint64_t bytes) {
  uint64_t sum = 0;
  for (uint64_t i = 0; i < bytes; i += 4096) sum += static_cast<volatile uint8_t*>(batch.data)[i];
  return sum;
}

// CPU seconds from the first counted batch to the last.
double Learn(const RunConfig& run, const ClusterAddress& address, int batches) {
  dds::Bus bus(address, run.config.transport, dds::Role::kLearner);
  const auto feed = learner::MakeFeed("", run, kLearnerSession, 0, bus, {});
  const uint64_t bytes = BatchSchemaOf(run).total_bytes();
  double start = 0;
  for (int i = 0; i < kWarmUp + batches; ++i) {
    if (i == kWarmUp) start = CpuSeconds();
    const auto batch = feed->stream().Next(Now() + kDeadline);
    if (!batch) throw RuntimeError("no batch came within {} s", kDeadline.count());
    LookAt(batch->view, bytes);
  }
  return CpuSeconds() - start;
}

}  // namespace

HandoverFigures MeasureHandover(const HandoverOptions& options) {
  const RunConfig run = RunOf(options.batch);
  Pipe<Meeting> meeting;
  Pipe<double> replay_word;
  Pipe<double> learner_word;
  const auto requests = static_cast<uint64_t>(options.batches);
  const pid_t replay = Fork("replay", [&] {
    const Meeting where = FreeMeeting(run.config.transport);
    EmptyReplay server(run, AddressOf(where), options.shared);
    meeting.Write(where);
    replay_word.Write(server.Serve(kWarmUp + 1, kWarmUp + requests));
    while (true) pause();  // its slots are read until the learner is through
  });
  const pid_t learner = Fork("learner", [&] {
    learner_word.Write(Learn(run, AddressOf(meeting.Read()), options.batches));
  });
  learner_word.CloseWriter();
  replay_word.CloseWriter();
  HandoverFigures figures;
  figures.learner_seconds = learner_word.Read();
  figures.replay_seconds = replay_word.Read();
  figures.gigabytes = options.batches * static_cast<double>(BatchSchemaOf(run).total_bytes()) / 1e9;
  kill(replay, SIGKILL);
  for (const pid_t child : {replay, learner}) waitpid(child, nullptr, 0);
  return figures;
}

}  // namespace shoal::bench
