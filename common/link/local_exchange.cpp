// SPDX-License-Identifier: Apache-2.0
#include "common/link/local_exchange.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"
#include "common/base/clock.h"

namespace shoal::link {
namespace {

// Waits without a deadline wake up this often, without effect.
constexpr std::chrono::minutes kIdleWait{1};

// Whether this thread is in a reader's callback. There, for example, a wait for the callback's end
// would never end.
thread_local bool in_callback = false;

void CheckNotInCallback(const TopicSettings& settings) {
  // The threads of a simulation share the variable.
  CHECK(!in_callback || Scheduler::Current() != nullptr)
      << "topic " << settings.name << ": a callback must not make or destroy writers and readers";
}

// noexcept: an exception from a callback ends the process here, with its cause on the stack.
void CallBack(const std::function<void(const StoredSample&)>& deliver,
              const StoredSample& sample) noexcept {
  in_callback = true;
  deliver(sample);
  in_callback = false;
}

}  // namespace

void LocalExchange::Add(Writer& writer) {
  CheckNotInCallback(writer.settings_);
  const MutexLock lock(mutex_);
  topics_[writer.settings_.name].writers.push_back(&writer);
}

void LocalExchange::Add(Reader& reader) {
  CheckNotInCallback(reader.settings_);
  std::vector<SharedSample> pushed_out;  // stays empty: the histories hold no more than the queue
  const MutexLock lock(mutex_);
  Ends& ends = topics_[reader.settings_.name];
  ends.readers.push_back(&reader);
  for (const Writer* writer : ends.writers) EnqueueHistory(*writer, reader, &pushed_out);
}

void LocalExchange::Remove(Writer& writer) {
  CheckNotInCallback(writer.settings_);
  std::list<SharedSample> history;  // freed without the lock
  const MutexLock lock(mutex_);
  std::erase(topics_[writer.settings_.name].writers, &writer);
  history = writer.history_.TakeAll();
}

void LocalExchange::Remove(Reader& reader) {
  CheckNotInCallback(reader.settings_);
  std::list<SharedSample> unread;  // freed without the lock
  const MutexLock lock(mutex_);
  std::erase(topics_[reader.settings_.name].readers, &reader);
  std::erase(reader.receiver_.ready_, &reader);
  unread = reader.queue_.TakeAll();
  for (const SharedSample& sample : unread) CountRead(*sample);
  while (reader.called_) reader.returned_.WaitUntil(mutex_, Now() + kIdleWait);
}

void LocalExchange::Abandon(const void* hub) {
  std::list<SharedSample> dropped;  // freed without the lock
  const MutexLock lock(mutex_);
  DropUnread(hub, &dropped);
  for (auto& [name, ends] : topics_) {
    std::erase_if(ends.writers, [&](const Writer* writer) { return writer->hub_ == hub; });
    std::erase_if(ends.readers, [&](const Reader* reader) { return reader->hub_ == hub; });
  }
  disconnected_.erase(hub);
}

void LocalExchange::Disconnect(const void* hub) {
  std::list<SharedSample> dropped;  // freed without the lock
  const MutexLock lock(mutex_);
  DropUnread(hub, &dropped);
  disconnected_.insert(hub);
}

void LocalExchange::Reconnect(const void* hub) {
  std::vector<SharedSample> pushed_out;  // freed without the lock
  const MutexLock lock(mutex_);
  if (disconnected_.erase(hub) == 0) return;
  for (auto& [name, ends] : topics_) {
    for (const Writer* writer : ends.writers) {
      for (Reader* reader : ends.readers) {
        const bool again = (writer->hub_ == hub) != (reader->hub_ == hub);
        if (again) EnqueueHistory(*writer, *reader, &pushed_out);
      }
    }
  }
}

void LocalExchange::DropUnread(const void* hub, std::list<SharedSample>* dropped) {
  for (auto& [name, ends] : topics_) {
    for (Reader* reader : ends.readers) {
      if (reader->hub_ != hub) continue;
      std::list<SharedSample> unread = reader->queue_.TakeAll();
      for (const SharedSample& sample : unread) CountRead(*sample);
      dropped->splice(dropped->end(), unread);
      std::erase(reader->receiver_.ready_, reader);
    }
  }
}

bool LocalExchange::WaitForRoom(Writer& writer, uint64_t bytes) {
  if (writer.settings_.keep_last > 0) return true;
  const SteadyTime deadline = Now() + writer.settings_.max_blocking;
  const MutexLock lock(mutex_);
  Unread& unread = *writer.unread_;
  while (unread.bytes > 0 && unread.bytes + bytes > writer.bound_) {
    if (Now() >= deadline) return false;
    unread.fell.WaitUntil(mutex_, deadline);
  }
  return true;
}

void LocalExchange::Put(Writer& writer, const SharedSample& sample) {
  std::vector<SharedSample> pushed_out;  // freed without the lock
  const MutexLock lock(mutex_);
  if (writer.settings_.late_joiners) {
    if (SharedSample old = writer.history_.Push(sample)) pushed_out.push_back(std::move(old));
  }
  if (!Connected(writer.hub_)) return;
  for (Reader* reader : topics_[writer.settings_.name].readers) {
    if (Connected(reader->hub_)) Enqueue(*reader, sample, &pushed_out);
  }
}

bool LocalExchange::WaitUntilRead(Writer& writer, SteadyTime deadline) {
  const MutexLock lock(mutex_);
  while (writer.unread_->samples > 0) {
    if (Now() >= deadline) return false;
    writer.unread_->fell.WaitUntil(mutex_, deadline);
  }
  return true;
}

int LocalExchange::Matched(const Writer& writer) const {
  const MutexLock lock(mutex_);
  if (!Connected(writer.hub_)) return 0;
  return CountConnected(topics_.find(writer.settings_.name)->second.readers);
}

int LocalExchange::Matched(const Reader& reader) const {
  const MutexLock lock(mutex_);
  if (!Connected(reader.hub_)) return 0;
  return CountConnected(topics_.find(reader.settings_.name)->second.writers);
}

void LocalExchange::ServeReaders(Receiver& receiver) {
  for (;;) {
    SharedSample sample;
    Reader* reader = WaitForReady(receiver, &sample);
    if (reader == nullptr) return;
    CallBack(reader->deliver_, *sample);
    FinishCall(*reader, *sample);
  }
}

void LocalExchange::Stop(Receiver& receiver) {
  const MutexLock lock(mutex_);
  receiver.stopping_ = true;
  receiver.changed_.NotifyAll();
}

void LocalExchange::Enqueue(Reader& reader, const SharedSample& sample,
                            std::vector<SharedSample>* pushed_out) {
  if (sample->unread_by++ == 0) {
    ++sample->unread().samples;
    sample->unread().bytes += sample->bytes();
  }
  // A reader that has samples, or whose callback runs, is in the list or will be added.
  const bool ready = reader.queue_.empty() && !reader.called_;
  if (SharedSample old = reader.queue_.Push(sample)) {
    CountRead(*old);
    pushed_out->push_back(std::move(old));
  }
  if (!ready) return;
  reader.receiver_.ready_.push_back(&reader);
  reader.receiver_.changed_.NotifyOne();
}

void LocalExchange::EnqueueHistory(const Writer& writer, Reader& reader,
                                   std::vector<SharedSample>* pushed_out) {
  if (!Connected(writer.hub_) || !Connected(reader.hub_)) return;
  for (const SharedSample& sample : writer.history_.samples()) {
    Enqueue(reader, sample, pushed_out);
  }
}

void LocalExchange::CountRead(StoredSample& sample) {
  if (--sample.unread_by > 0) return;
  --sample.unread().samples;
  sample.unread().bytes -= sample.bytes();
  sample.unread().fell.NotifyAll();
}

LocalExchange::Reader* LocalExchange::WaitForReady(Receiver& receiver, SharedSample* sample) {
  const MutexLock lock(mutex_);
  while (receiver.ready_.empty()) {
    if (receiver.stopping_) return nullptr;
    receiver.changed_.WaitUntil(mutex_, Now() + kIdleWait);
  }
  const size_t chosen = choose_ ? choose_(receiver.ready_.size()) : 0;
  Reader* reader = receiver.ready_[chosen];
  receiver.ready_.erase(receiver.ready_.begin() + static_cast<std::ptrdiff_t>(chosen));
  *sample = reader->queue_.Pop();
  reader->called_ = true;
  return reader;
}

void LocalExchange::FinishCall(Reader& reader, StoredSample& sample) {
  const MutexLock lock(mutex_);
  CountRead(sample);
  reader.called_ = false;
  // The reader is added at the end, so that others get their turn.
  if (!reader.queue_.empty()) reader.receiver_.ready_.push_back(&reader);
  reader.returned_.NotifyAll();
}

}  // namespace shoal::link
