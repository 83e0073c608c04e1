// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <span>
#include <utility>

#include "common/base/clock.h"
#include "common/base/log.h"
#include "common/dds/bulk_cdr.h"
#include "common/dds/bus.h"
#include "common/dds/message_cdr.h"
// clang-format off
#include "common/dds/endpoint.h"
#include "dds/ddsi/ddsi_serdata.h"
// clang-format on

namespace shoal::dds {
namespace {

using link::Topic;
using link::TopicSettings;

// Samples taken from the reader's cache at a time.
constexpr uint32_t kTakeAtOnce = 16;
constexpr std::chrono::seconds kMalformedLogInterval{10};

// A view of a taken sample's CDR bytes. Returns the sample at the end of its scope.
class TakenCdr {
 public:
  explicit TakenCdr(ddsi_serdata* data)
      : data_(data), held_(ddsi_serdata_to_ser_ref(data, 0, ddsi_serdata_size(data), &bytes_)) {}
  ~TakenCdr() {
    ddsi_serdata_to_ser_unref(held_, &bytes_);
    ddsi_serdata_unref(data_);
  }
  TakenCdr(const TakenCdr&) = delete;
  TakenCdr& operator=(const TakenCdr&) = delete;

  std::span<const uint8_t> bytes() const {
    return {static_cast<const uint8_t*>(bytes_.iov_base), bytes_.iov_len};
  }

 private:
  ddsi_serdata* data_;
  ddsrt_iovec_t bytes_{};
  ddsi_serdata* held_;
};

// Empties the reader's cache and calls deliver(well_formed, message) for each sample. False if the
// cache was empty.
template <class M, class Deliver>
bool TakeCdr(dds_entity_t reader, const Deliver& deliver) {
  ddsi_serdata* samples[kTakeAtOnce];
  dds_sample_info_t infos[kTakeAtOnce];
  const dds_return_t taken = dds_takecdr(reader, samples, kTakeAtOnce, infos, DDS_ANY_STATE);
  for (dds_return_t i = 0; i < taken; ++i) {
    const TakenCdr cdr(samples[i]);
    if (!infos[i].valid_data) continue;  // reports a writer's end
    M message;
    deliver(ParseCdr(cdr.bytes(), &message), message);
  }
  return taken > 0;
}

template <class M>
class DdsReader final : public link::ReaderEnd {
 public:
  DdsReader(Bus& bus, std::function<void(const M&)> callback)
      : on_message_(std::move(callback)),
        malformed_(bus.impl().MalformedCounter(Topic<M>::kSettings.name)),
        topic_(CreateTopic<M>(bus)) {
    // The listener is set when the reader is created, so no sample can arrive unnoticed.
    const TopicSettings& settings = Topic<M>::kSettings;
    const ListenerHandle listener = MakeListener<M>(this);
    dds_lset_data_available(listener.get(), &DdsReader::OnData);
    callbacks_.store(0, std::memory_order_release);
    reader_ = Entity(dds_create_reader(bus.impl().Participant(settings.plane), topic_.get(),
                                       MakeQos(settings).get(), listener.get()),
                     std::string("reader of topic ") + settings.name);
  }

  // Cyclone waits for a running callback before it resets the listener. No callback starts
  // afterwards.
  ~DdsReader() override {
    if (reader_) dds_set_listener(reader_.get(), nullptr);
    reader_.Reset();
    (void)callbacks_.load(std::memory_order_acquire);
  }
  DdsReader(const DdsReader&) = delete;
  DdsReader& operator=(const DdsReader&) = delete;

  int Matched() const override {
    dds_subscription_matched_status_t status{};
    dds_get_subscription_matched_status(reader_.get(), &status);
    return static_cast<int>(status.current_count);
  }

  uint64_t Malformed() const override { return malformed_->load(std::memory_order_relaxed); }

 private:
  // An exception from the callback would unwind through C, so noexcept ends the process.
  static void OnData(dds_entity_t handle, void* argument) noexcept {
    auto* self = static_cast<DdsReader*>(argument);
    (void)self->callbacks_.load(std::memory_order_acquire);
    const auto deliver = [self](bool well_formed, const M& message) {
      self->Deliver(well_formed, message);
    };
    while (TakeCdr<M>(handle, deliver)) {
    }
    self->callbacks_.fetch_add(1, std::memory_order_release);
  }

  void Deliver(bool well_formed, const M& message) {
    if (well_formed) {
      on_message_(message);
    } else {
      OnMalformed(malformed_->fetch_add(1, std::memory_order_relaxed) + 1);
    }
  }

  // Logs at most one line per interval and topic.
  void OnMalformed(uint64_t count) {
    if (Now() - last_said_ < kMalformedLogInterval) return;
    last_said_ = Now();
    log::Warning("dds: topic {}: {} malformed message(s) dropped, {} in all",
                 Topic<M>::kSettings.name, count - said_, count);
    said_ = count;
  }

  std::function<void(const M&)> on_message_;
  std::shared_ptr<std::atomic<uint64_t>> malformed_;  // shared with the bus
  SteadyTime last_said_{};                            // used by the receive thread, like `said_`
  uint64_t said_ = 0;
  // Number of calls of OnData. The counter orders OnData after the constructor and before the
  // destructor for the thread sanitizer, which cannot see Cyclone's own locks.
  std::atomic<uint64_t> callbacks_{0};
  Entity topic_;
  Entity reader_;
};

}  // namespace

#define SHOAL_MAKE_READER(message, ...)                                             \
  std::unique_ptr<link::ReaderEnd> Bus::MakeReader(                                 \
      link::MessageType<message>, std::function<void(const message&)> on_message) { \
    return std::make_unique<DdsReader<message>>(*this, std::move(on_message));      \
  }
SHOAL_MESSAGES(SHOAL_MAKE_READER)
#undef SHOAL_MAKE_READER

}  // namespace shoal::dds
