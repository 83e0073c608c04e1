// SPDX-License-Identifier: Apache-2.0
// The commands for one message type (described in peer_commands.h).
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/base/clock.h"
#include "common/link/reader.h"
#include "common/link/writer.h"
#include "tests/common/link/example_messages.h"
#include "tests/common/link/message_text.h"
#include "tests/common/link/peer_commands.h"

namespace shoal::link {

inline constexpr std::chrono::seconds kPeerWriteDeadline{30};
inline constexpr std::chrono::milliseconds kPeerPollInterval{1};

class PeerCommands::Endpoint {
 public:
  using milliseconds = std::chrono::milliseconds;

  virtual ~Endpoint() = default;
  virtual void Subscribe(Hub& hub, bool show) = 0;
  virtual void Unsubscribe() = 0;
  virtual bool WaitForUnsubscribed(milliseconds deadline) = 0;
  virtual void Publish(Hub& hub) = 0;
  virtual void Unpublish() = 0;
  virtual std::string Match(int count, milliseconds deadline) = 0;
  virtual std::string Write(uint64_t first, uint64_t count, size_t payload_bytes,
                            std::optional<uint64_t> key) = 0;
  virtual std::string Scribble(uint64_t first, uint64_t count, size_t payload_bytes) = 0;
  virtual std::string Try(uint64_t n, size_t payload_bytes, bool announce) = 0;
  virtual std::string Received(uint64_t count, milliseconds deadline) = 0;
  virtual std::string Seen() = 0;
  virtual void Hold(bool held) = 0;
  virtual bool WaitForHeld(milliseconds deadline) = 0;
  virtual std::string Overlaps() = 0;
  virtual bool Acknowledged(milliseconds deadline) = 0;
};

// Sets the key of a message. Does nothing if the topic has no keys.
template <class M>
void SetKey(uint64_t, M*) {}
inline void SetKey(uint64_t key, WeightsPart* m) { m->part = static_cast<uint32_t>(key); }
inline void SetKey(uint64_t key, EvalWeightsPart* m) { m->part = static_cast<uint32_t>(key); }
inline void SetKey(uint64_t key, ReplayProgress* m) { m->replay = static_cast<uint32_t>(key); }
inline void SetKey(uint64_t key, CommandMessage* m) { m->client = key; }
inline void SetKey(uint64_t key, ReplyMessage* m) { m->client = key; }
template <class M>
requires std::derived_from<M, MetricsMessage>
void SetKey(uint64_t key, M* m) { m->id = static_cast<uint32_t>(key); }

template <class M>
class PeerEndpoint final : public PeerCommands::Endpoint {
 public:
  PeerEndpoint(std::string name, std::function<void(const std::string&)> say)
      : name_(std::move(name)), say_(std::move(say)) {}
  ~PeerEndpoint() override { Hold(false); }

  void Subscribe(Hub& hub, bool show) override {
    reader_.emplace(hub, [this, show](const M& message) { OnMessage(message, show); });
  }

  void Unsubscribe() override {
    unsubscribed_ = false;
    unsubscribing_ = std::jthread([this] {
      reader_.reset();
      const std::lock_guard lock(mutex_);
      unsubscribed_ = true;
      changed_.notify_all();
    });
  }

  bool WaitForUnsubscribed(milliseconds deadline) override {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, deadline, [&] { return unsubscribed_; });
  }

  void Publish(Hub& hub) override { writer_.emplace(hub); }
  void Unpublish() override { writer_.reset(); }

  std::string Match(int count, milliseconds deadline) override {
    const SteadyTime start = Now();
    while (Matched() != count && Now() - start < deadline)
      std::this_thread::sleep_for(kPeerPollInterval);
    return fmt::format("matched {}", Matched());
  }

  std::string Write(uint64_t first, uint64_t count, size_t payload_bytes,
                    std::optional<uint64_t> key) override {
    const std::vector<uint8_t> payload = ExamplePayload(first, payload_bytes);
    const SteadyTime start = Now();
    uint64_t refused = 0, written = 0;
    while (written < count && Now() - start < kPeerWriteDeadline) {
      WithExample<M>(first + written, payload, [&](const M& example) {
        M message = example;
        if (key) SetKey(*key, &message);
        writer_->Write(message) ? ++written : ++refused;
      });
    }
    return fmt::format("wrote {} refused {} seconds {:.3f}", written, refused, SecondsSince(start));
  }

  std::string Scribble(uint64_t first, uint64_t count, size_t payload_bytes) override {
    const SteadyTime start = Now();
    uint64_t refused = 0, written = 0;
    std::vector<uint8_t> buffer(payload_bytes);
    while (written < count && Now() - start < kPeerWriteDeadline) {
      const uint64_t n = first + written;
      std::ranges::copy(ExamplePayload(n, payload_bytes), buffer.begin());
      std::jthread([&] {
        WithExample<M>(n, buffer,
                       [&](const M& message) { writer_->Write(message) ? ++written : ++refused; });
      }).join();
      std::ranges::fill(buffer, uint8_t{0xee});
    }
    return fmt::format("wrote {} refused {} seconds {:.3f}", written, refused, SecondsSince(start));
  }

  std::string Try(uint64_t n, size_t payload_bytes, bool announce) override {
    const std::vector<uint8_t> payload = ExamplePayload(n, payload_bytes);
    bool sent = false;
    if (announce) say_("got trying " + name_);
    const SteadyTime start = Now();
    WithExample<M>(n, payload, [&](const M& message) { sent = writer_->Write(message); });
    return fmt::format("{} {:.0f}", sent ? "sent" : "refused", SecondsSince(start) * 1e3);
  }

  std::string Received(uint64_t count, milliseconds deadline) override {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, deadline, [&] { return seen_.size() >= count; });
    return fmt::format("received {} gaps {} bytes {} malformed {}", seen_.size(), gaps_, bytes_,
                       reader_ ? reader_->Malformed() : 0);
  }

  std::string Seen() override {
    const std::lock_guard lock(mutex_);
    std::string text = "seen";
    for (const auto& [key, number] : seen_) text += fmt::format(" {}:{}", key, number);
    return text;
  }

  void Hold(bool held) override {
    const std::lock_guard lock(mutex_);
    held_ = held;
    changed_.notify_all();
  }

  bool WaitForHeld(milliseconds deadline) override {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, deadline, [&] { return waiting_ > 0; });
  }

  std::string Overlaps() override { return fmt::format("overlaps {}", overlaps_.load()); }

  bool Acknowledged(milliseconds deadline) override { return writer_->WaitForAcks(deadline); }

 private:
  int Matched() const {
    return (writer_ ? writer_->Matched() : 0) + (reader_ ? reader_->Matched() : 0);
  }

  void OnMessage(const M& message, bool show) {
    if (running_.exchange(true)) ++overlaps_;
    std::this_thread::yield();  // gives a forbidden concurrent callback a chance to run
    {
      std::unique_lock lock(mutex_);
      ++waiting_;
      changed_.notify_all();
      changed_.wait(lock, [&] { return !held_; });
      --waiting_;
    }
    if (show) say_(fmt::format("got {} {}", name_, Describe(message)));
    {
      const std::lock_guard lock(mutex_);
      if (!seen_.empty() && Number(message) != seen_.back().second + 1) ++gaps_;
      seen_.emplace_back(KeyOf(message).second, Number(message));
      if constexpr (requires { message.payload; }) bytes_ += message.payload.size();
      changed_.notify_all();
    }
    running_ = false;
  }

  const std::string name_;
  const std::function<void(const std::string&)> say_;
  std::optional<Writer<M>> writer_;
  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_.
  std::vector<std::pair<uint64_t, uint64_t>> seen_;  // key and number
  uint64_t gaps_ = 0, bytes_ = 0;
  bool held_ = false, unsubscribed_ = false;
  int waiting_ = 0;  // callbacks that wait for the end of the hold
  std::atomic<bool> running_{false};
  std::atomic<uint64_t> overlaps_{0};
  std::optional<Reader<M>> reader_;  // the callback uses the members above
  std::jthread unsubscribing_;       // the thread uses reader_
};

}  // namespace shoal::link
