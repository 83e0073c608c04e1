// Typed readers that call back from a DDS receive thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "common/dds/bus.h"
#include "common/wire/messages.h"

namespace shoal::dds {

template <class M>
class Subscriber {
 public:
  // `on_message` runs on a receive thread of the bus (or on the writing thread when the writer is
  // in this process), one call at a time, and may run before the constructor returns. It must not
  // block, throw or create entities; it copies what it keeps. Malformed samples are counted, not
  // delivered. Borrows the bus. Throws Error when DDS refuses.
  Subscriber(Bus& bus, std::function<void(const M&)> on_message);
  // After return no callback runs. Not to be called from the callback.
  ~Subscriber();
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;

  // Matched writers now.
  int Matched() const;
  uint64_t Malformed() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

extern template class Subscriber<TransitionChunk>;
extern template class Subscriber<CreditsMessage>;
extern template class Subscriber<SampleRequest>;
extern template class Subscriber<BatchShard>;
extern template class Subscriber<WeightsMessage>;
extern template class Subscriber<EvalWeightsMessage>;
extern template class Subscriber<MetricsMessage>;
extern template class Subscriber<ControlMessage>;
extern template class Subscriber<EvalMessage>;
extern template class Subscriber<RunViewMessage>;
extern template class Subscriber<CommandMessage>;
extern template class Subscriber<ReplyMessage>;

}  // namespace shoal::dds
