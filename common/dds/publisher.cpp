// SPDX-License-Identifier: Apache-2.0
#include "common/dds/publisher.h"

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/log.h"
// clang-format off
#include "common/dds/endpoint.h"
// clang-format on

namespace shoal::dds {
namespace {

constexpr std::chrono::seconds kFailureLogInterval{1};

template <class M>
Entity CreateWriter(Bus& bus, const Entity& topic) {
  const TopicSettings& settings = Topic<M>::kSettings;
  return Entity(dds_create_writer(bus.impl().Participant(settings.plane), topic.get(),
                                  MakeQos(settings).get(), MakeListener<M>(nullptr).get()),
                std::string("writer of topic ") + settings.name);
}

}  // namespace

template <class M>
struct Publisher<M>::Impl {
  explicit Impl(Bus& bus) : topic(CreateTopic<M>(bus)), writer(CreateWriter<M>(bus, topic)) {}

  void LogFailure(dds_return_t result) {
    if (Now() - last_failure_log < kFailureLogInterval) return;
    last_failure_log = Now();
    log::Failure("dds: topic {}: write failed: {}", Topic<M>::kSettings.name,
                 dds_strretcode(-result));
  }

  Entity topic;
  Entity writer;
  WireBuffers buffers;
  SteadyTime last_failure_log{};
};

template <class M>
Publisher<M>::Publisher(Bus& bus) : impl_(std::make_unique<Impl>(bus)) {}

template <class M>
Publisher<M>::~Publisher() = default;

template <class M>
bool Publisher<M>::Write(const M& message) {
  if constexpr (requires { message.payload; }) {
    CHECK(message.payload.size() <= kMaxPayloadBytes)
        << Topic<M>::kSettings.name << ": payload of " << message.payload.size() << " bytes";
  }
  const typename Topic<M>::Wire sample = ToWire(message, &impl_->buffers);
  const dds_return_t result = dds_write(impl_->writer.get(), &sample);
  if (result != DDS_RETCODE_OK && result != DDS_RETCODE_TIMEOUT) impl_->LogFailure(result);
  return result == DDS_RETCODE_OK;
}

template <class M>
int Publisher<M>::Matched() const {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(impl_->writer.get(), &status);
  return static_cast<int>(status.current_count);
}

template <class M>
bool Publisher<M>::WaitForAcks(std::chrono::milliseconds deadline) {
  return dds_wait_for_acks(impl_->writer.get(), DDS_MSECS(deadline.count())) == DDS_RETCODE_OK;
}

#define SHOAL_INSTANTIATE(message, ...) template class Publisher<message>;
SHOAL_MESSAGES(SHOAL_INSTANTIATE)
#undef SHOAL_INSTANTIATE

}  // namespace shoal::dds
