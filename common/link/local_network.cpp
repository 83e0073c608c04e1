// SPDX-License-Identifier: Apache-2.0
#include "common/link/local_network.h"

#include <map>
#include <set>
#include <string>
#include <utility>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/mutex.h"
#include "common/base/thread_group.h"

namespace shoal::link {
namespace {

// Counts its living instances in `count`.
class Counted {
 public:
  explicit Counted(std::atomic<int>& count) : count_(count) { ++count_; }
  ~Counted() { --count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  std::atomic<int>& count_;
};

template <class M>
class LocalWriter final : public WriterEnd<M> {
 public:
  LocalWriter(LocalExchange& exchange, const Hub* hub, std::atomic<int>& ends, Role role)
      : counted_(ends),
        exchange_(exchange),
        writer_(hub, Topic<M>::kSettings, UnreadBytesBound(role)) {
    exchange_.Add(writer_);
  }
  ~LocalWriter() override { exchange_.Remove(writer_); }

  // Waits for room before the copy, so that a refused message is not copied. One thread at a time
  // writes, so the room does not shrink before Put.
  bool Write(const M& message) override {
    if (!exchange_.WaitForRoom(writer_, StoredMessage<M>::Bytes(message))) return false;
    exchange_.Put(writer_, std::make_shared<StoredMessage<M>>(writer_.unread(), message));
    return true;
  }

  int Matched() const override { return exchange_.Matched(writer_); }

  bool WaitForAcks(std::chrono::milliseconds deadline) override {
    return exchange_.WaitUntilRead(writer_, Now() + deadline);
  }

 private:
  const Counted counted_;
  LocalExchange& exchange_;
  LocalExchange::Writer writer_;
};

template <class M>
class LocalReader final : public ReaderEnd {
 public:
  LocalReader(LocalExchange& exchange, const Hub* hub, LocalExchange::Receiver& receiver,
              std::atomic<int>& ends, std::function<void(const M&)> on_message)
      : counted_(ends),
        exchange_(exchange),
        reader_(hub, Topic<M>::kSettings, receiver,
                [on_message = std::move(on_message)](const StoredSample& sample) {
                  on_message(static_cast<const StoredMessage<M>&>(sample).message());
                }) {
    exchange_.Add(reader_);
  }
  ~LocalReader() override { exchange_.Remove(reader_); }

  int Matched() const override { return exchange_.Matched(reader_); }
  uint64_t Malformed() const override { return 0; }  // messages are not serialised

 private:
  const Counted counted_;
  LocalExchange& exchange_;
  LocalExchange::Reader reader_;
};

// The thread that calls a hub's readers of one plane.
class ReceiveThread {
 public:
  explicit ReceiveThread(LocalExchange& exchange)
      : exchange_(exchange), thread_([this] { exchange_.ServeReaders(receiver_); }) {}
  ~ReceiveThread() {
    exchange_.Stop(receiver_);
    thread_.join();
  }
  ReceiveThread(const ReceiveThread&) = delete;
  ReceiveThread& operator=(const ReceiveThread&) = delete;

  LocalExchange::Receiver& receiver() { return receiver_; }

 private:
  LocalExchange& exchange_;
  LocalExchange::Receiver receiver_;
  Thread thread_;
};

class LocalHub final : public Hub {
 public:
  LocalHub(LocalExchange& exchange, std::atomic<int>& hubs, Role role)
      : counted_(hubs), exchange_(exchange), role_(role) {}
  ~LocalHub() override {
    CHECK(ends_ == 0) << "hub of role " << RoleName(role_) << ": " << ends_
                      << " writers and readers are left";
    exchange_.Reconnect(this);  // the next hub may have this address
  }

  std::map<std::string, uint64_t> Malformed() const override {
    const MutexLock lock(mutex_);
    std::map<std::string, uint64_t> counts;
    for (const char* topic : read_topics_) counts[topic] = 0;
    return counts;
  }

#define SHOAL_LOCAL_ENDS(message, ...)                                                           \
  std::unique_ptr<WriterEnd<message>> MakeWriter(MessageType<message>) override {                \
    return MakeWriterOf<message>();                                                              \
  }                                                                                              \
  std::unique_ptr<ReaderEnd> MakeReader(MessageType<message>,                                    \
                                        std::function<void(const message&)> callback) override { \
    return MakeReaderOf<message>(std::move(callback));                                           \
  }
  SHOAL_MESSAGES(SHOAL_LOCAL_ENDS)
#undef SHOAL_LOCAL_ENDS

 private:
  void CheckPlane(const TopicSettings& settings) const {
    CHECK(Joins(role_, settings.plane))
        << "topic " << settings.name << ": role " << RoleName(role_) << " is not in its plane";
  }

  template <class M>
  std::unique_ptr<WriterEnd<M>> MakeWriterOf() {
    CheckPlane(Topic<M>::kSettings);
    return std::make_unique<LocalWriter<M>>(exchange_, this, ends_, role_);
  }

  template <class M>
  std::unique_ptr<ReaderEnd> MakeReaderOf(std::function<void(const M&)> on_message) {
    CheckPlane(Topic<M>::kSettings);
    return std::make_unique<LocalReader<M>>(exchange_, this, ReceiverFor(Topic<M>::kSettings),
                                            ends_, std::move(on_message));
  }

  // Returns the receiver of the topic's plane; its thread starts with the plane's first reader.
  LocalExchange::Receiver& ReceiverFor(const TopicSettings& settings) {
    const MutexLock lock(mutex_);
    read_topics_.insert(settings.name);
    std::unique_ptr<ReceiveThread>& thread = threads_[settings.plane];
    if (!thread) thread = std::make_unique<ReceiveThread>(exchange_);
    return thread->receiver();
  }

  const Counted counted_;
  LocalExchange& exchange_;
  const Role role_;
  std::atomic<int> ends_{0};
  mutable Mutex mutex_;
  std::set<const char*> read_topics_ SHOAL_GUARDED_BY(mutex_);
  std::map<Plane, std::unique_ptr<ReceiveThread>> threads_ SHOAL_GUARDED_BY(mutex_);
};

}  // namespace

void LocalNetwork::Abandon(const Hub& hub) { exchange_.Abandon(&hub); }
void LocalNetwork::Disconnect(const Hub& hub) { exchange_.Disconnect(&hub); }
void LocalNetwork::Reconnect(const Hub& hub) { exchange_.Reconnect(&hub); }

LocalNetwork::~LocalNetwork() { CHECK(hubs_ == 0) << hubs_ << " hubs outlive their network"; }

std::unique_ptr<Hub> LocalNetwork::Join(Role role) {
  return std::make_unique<LocalHub>(exchange_, hubs_, role);
}

}  // namespace shoal::link
