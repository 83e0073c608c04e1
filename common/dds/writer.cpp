// SPDX-License-Identifier: Apache-2.0
#include "common/base/clock.h"
#include "common/base/log.h"
#include "common/dds/bus.h"
#include "common/dds/wire_types.h"
// clang-format off
#include "common/dds/endpoint.h"
// clang-format on

namespace shoal::dds {
namespace {

using link::Topic;
using link::TopicSettings;

constexpr std::chrono::seconds kFailureLogInterval{1};

template <class M>
Entity CreateWriter(Bus& bus, const Entity& topic) {
  const TopicSettings& settings = Topic<M>::kSettings;
  return Entity(dds_create_writer(bus.impl().Participant(settings.plane), topic.get(),
                                  MakeQos(settings).get(), MakeListener<M>(nullptr).get()),
                std::string("writer of topic ") + settings.name);
}

template <class M>
class DdsWriter final : public link::WriterEnd<M> {
 public:
  explicit DdsWriter(Bus& bus)
      : topic_(CreateTopic<M>(bus)), writer_(CreateWriter<M>(bus, topic_)) {}

  bool Write(const M& message) override {
    const typename WireType<M>::Wire sample = ToWire(message, &buffers_);
    const dds_return_t result = dds_write(writer_.get(), &sample);
    if (result != DDS_RETCODE_OK && result != DDS_RETCODE_TIMEOUT) LogFailure(result);
    return result == DDS_RETCODE_OK;
  }

  int Matched() const override {
    dds_publication_matched_status_t status{};
    dds_get_publication_matched_status(writer_.get(), &status);
    return static_cast<int>(status.current_count);
  }

  bool WaitForAcks(std::chrono::milliseconds deadline) override {
    return dds_wait_for_acks(writer_.get(), DDS_MSECS(deadline.count())) == DDS_RETCODE_OK;
  }

 private:
  void LogFailure(dds_return_t result) {
    if (Now() - last_failure_log_ < kFailureLogInterval) return;
    last_failure_log_ = Now();
    log::Failure("dds: topic {}: write failed: {}", Topic<M>::kSettings.name,
                 dds_strretcode(-result));
  }

  Entity topic_;
  Entity writer_;
  WireBuffers buffers_;
  SteadyTime last_failure_log_{};
};

}  // namespace

#define SHOAL_MAKE_WRITER(message, ...)                                                   \
  std::unique_ptr<link::WriterEnd<message>> Bus::MakeWriter(link::MessageType<message>) { \
    return std::make_unique<DdsWriter<message>>(*this);                                   \
  }
SHOAL_MESSAGES(SHOAL_MAKE_WRITER)
#undef SHOAL_MAKE_WRITER

}  // namespace shoal::dds
