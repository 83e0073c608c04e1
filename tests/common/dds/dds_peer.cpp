// SPDX-License-Identifier: Apache-2.0
// The other process of the DDS tests: joins a domain in a role and does what it reads from stdin,
// one answer line on stdout per command. T is the name of a message type.
//
//   dds_peer ROLE DOMAIN TAG [SECURE]   says "joined"
//   dds_peer claim [SECURE]             is the coordinator of a free domain; "joined DOMAIN TAG"
//
// SECURE is a folder of credentials.
//
//   subscribe T                counts what arrives; "ok"
//   show T                     subscribes and also prints "got T DESCRIPTION" for each message
//   publish T                  creates the writer; "ok"
//   match T N MS               waits until reader and writer of T together have N peers;
//                              "matched N"
//   write T FIRST COUNT BYTES  writes numbered messages, repeating those that are refused;
//                              "wrote COUNT refused N seconds S"
//   try T N BYTES              one write; "sent MS" or "refused MS"
//   received T COUNT MS        waits for COUNT messages; "received N gaps N bytes N malformed N"
//   acknowledged T MS          "yes" or "no"
//   answer                     stores nothing, but answers every chunk with a credit; "ok"
//   roundtrip COUNT BYTES      chunk out, credit back, COUNT > 1 times; "microseconds MEDIAN MAX,
//                              first FIRST": the first one waits for the reader's side of matching
//   deafmute MS                drops everything in and out; "ok"
//   quit
#include <dds/dds.h>
#include <sys/prctl.h>

#include <algorithm>
#include <condition_variable>
#include <csignal>
#include <functional>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <thread>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/main_guard.h"
#include "common/dds/bus_impl.h"
#include "common/link/message_list.h"
#include "common/link/writer.h"
#include "common/link/reader.h"
#include "tests/common/dds/example_messages.h"

namespace shoal::dds {
namespace {

using std::chrono::milliseconds;

constexpr std::chrono::seconds kWriteDeadline{30};
constexpr milliseconds kPollInterval{1};

std::mutex output_mutex;
void Say(const std::string& line) {
  const std::lock_guard lock(output_mutex);
  std::cout << line << std::endl;
}

// The commands of one message type.
class AnyEndpoint {
 public:
  virtual ~AnyEndpoint() = default;
  virtual void Subscribe(Bus& bus, bool show) = 0;
  virtual void Publish(Bus& bus) = 0;
  virtual std::string Match(int count, milliseconds deadline) = 0;
  virtual std::string Write(uint64_t first, uint64_t count, size_t payload_bytes) = 0;
  virtual std::string Try(uint64_t n, size_t payload_bytes) = 0;
  virtual std::string Received(uint64_t count, milliseconds deadline) = 0;
  virtual std::string Acknowledged(milliseconds deadline) = 0;
};

template <class M>
class Endpoint : public AnyEndpoint {
 public:
  explicit Endpoint(std::string name) : name_(std::move(name)) {}

  void Subscribe(Bus& bus, bool show) override {
    subscriber_.emplace(bus, [this, show](const M& message) { OnMessage(message, show); });
  }

  void Publish(Bus& bus) override { publisher_.emplace(bus); }

  std::string Match(int count, milliseconds deadline) override {
    const SteadyTime start = Now();
    while (Matched() != count && Now() - start < deadline)
      std::this_thread::sleep_for(kPollInterval);
    return fmt::format("matched {}", Matched());
  }

  std::string Write(uint64_t first, uint64_t count, size_t payload_bytes) override {
    const std::vector<uint8_t> payload = ExamplePayload(first, payload_bytes);
    const SteadyTime start = Now();
    uint64_t refused = 0, written = 0;
    while (written < count && Now() - start < kWriteDeadline) {
      WithExample<M>(first + written, payload,
                     [&](const M& message) { publisher_->Write(message) ? ++written : ++refused; });
    }
    return fmt::format("wrote {} refused {} seconds {:.3f}", written, refused, SecondsSince(start));
  }

  std::string Try(uint64_t n, size_t payload_bytes) override {
    const std::vector<uint8_t> payload = ExamplePayload(n, payload_bytes);
    bool sent = false;
    const SteadyTime start = Now();
    WithExample<M>(n, payload, [&](const M& message) { sent = publisher_->Write(message); });
    return fmt::format("{} {:.0f}", sent ? "sent" : "refused", SecondsSince(start) * 1e3);
  }

  std::string Received(uint64_t count, milliseconds deadline) override {
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, deadline, [&] { return received_ >= count; });
    return fmt::format("received {} gaps {} bytes {} malformed {}", received_, gaps_, bytes_,
                       subscriber_->Malformed());
  }

  std::string Acknowledged(milliseconds deadline) override {
    return publisher_->WaitForAcks(deadline) ? "yes" : "no";
  }

 private:
  int Matched() const {
    return (publisher_ ? publisher_->Matched() : 0) + (subscriber_ ? subscriber_->Matched() : 0);
  }

  void OnMessage(const M& message, bool show) {
    if (show) Say(fmt::format("got {} {}", name_, Describe(message)));
    const std::lock_guard lock(mutex_);
    if (received_ > 0 && Number(message) != last_ + 1) ++gaps_;
    last_ = Number(message);
    ++received_;
    if constexpr (requires { message.payload; }) bytes_ += message.payload.size();
    arrived_.notify_all();
  }

  const std::string name_;
  std::optional<link::Writer<M>> publisher_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  uint64_t received_ = 0, gaps_ = 0, bytes_ = 0, last_ = 0;  // guarded by mutex_
  std::optional<link::Reader<M>> subscriber_;                  // last: its callback uses the rest
};

// Answers each chunk with a credit from a thread of its own, as a replay does.
class Answerer {
 public:
  explicit Answerer(Bus& bus)
      : publisher_(bus),
        thread_([this](const std::stop_token& stop) { Run(stop); }),
        subscriber_(bus, [this](const TransitionChunk& chunk) {
          const std::lock_guard lock(mutex_);
          newest_ = chunk.first_sequence;
          arrived_.notify_all();
        }) {}

 private:
  void Run(const std::stop_token& stop) {
    uint64_t answered = 0;
    while (!stop.stop_requested()) {
      {
        std::unique_lock lock(mutex_);
        arrived_.wait(lock, stop, [&] { return newest_ != answered; });
        answered = newest_;
      }
      WithExample<CreditsMessage>(
          answered, {}, [&](const CreditsMessage& credits) { publisher_.Write(credits); });
    }
  }

  link::Writer<CreditsMessage> publisher_;
  std::mutex mutex_;
  std::condition_variable_any arrived_;
  uint64_t newest_ = 0;  // guarded by mutex_
  std::jthread thread_;
  link::Reader<TransitionChunk> subscriber_;
};

std::string RoundTrip(Bus& bus, uint64_t count, size_t payload_bytes) {
  std::mutex mutex;
  std::condition_variable arrived;
  uint64_t stored = 0;
  link::Writer<TransitionChunk> publisher(bus);
  const link::Reader<CreditsMessage> subscriber(bus, [&](const CreditsMessage& credits) {
    const std::lock_guard lock(mutex);
    stored = credits.credits.front().stored;
    arrived.notify_all();
  });
  const SteadyTime start = Now();
  while ((publisher.Matched() < 1 || subscriber.Matched() < 1) && Now() - start < kWriteDeadline) {
    std::this_thread::sleep_for(kPollInterval);
  }
  const std::vector<uint8_t> payload = ExamplePayload(1, payload_bytes);
  std::vector<double> microseconds;
  for (uint64_t n = 1; n <= count; ++n) {
    const SteadyTime sent = Now();
    WithExample<TransitionChunk>(n, payload, [&](const auto& m) { publisher.Write(m); });
    std::unique_lock lock(mutex);
    if (!arrived.wait_for(lock, kWriteDeadline, [&] { return stored == n; })) return "lost";
    microseconds.push_back(SecondsSince(sent) * 1e6);
  }
  const double first = microseconds.front();
  microseconds.erase(microseconds.begin());
  std::ranges::sort(microseconds);
  return fmt::format("microseconds {:.0f} {:.0f}, first {:.0f}",
                     microseconds[microseconds.size() / 2], microseconds.back(), first);
}

using Endpoints = std::map<std::string, std::unique_ptr<AnyEndpoint>>;

template <class M>
void Add(Endpoints* endpoints, const std::string& name) {
  endpoints->emplace(name, std::make_unique<Endpoint<M>>(name));
}

Endpoints AllEndpoints() {
  Endpoints endpoints;
#define SHOAL_ADD(message, ...) Add<message>(&endpoints, #message);
  SHOAL_MESSAGES(SHOAL_ADD)
#undef SHOAL_ADD
  return endpoints;
}

// The answer to a command about one message type.
std::string RunTyped(const std::string& verb, std::istream& words, Bus& bus,
                     AnyEndpoint& endpoint) {
  uint64_t a = 0, b = 0, c = 0;
  words >> a >> b >> c;
  if (verb == "subscribe") return endpoint.Subscribe(bus, false), "ok";
  if (verb == "show") return endpoint.Subscribe(bus, true), "ok";
  if (verb == "publish") return endpoint.Publish(bus), "ok";
  if (verb == "match") return endpoint.Match(static_cast<int>(a), milliseconds(b));
  if (verb == "write") return endpoint.Write(a, b, c);
  if (verb == "try") return endpoint.Try(a, b);
  if (verb == "received") return endpoint.Received(a, milliseconds(b));
  if (verb == "acknowledged") return endpoint.Acknowledged(milliseconds(a));
  return "unknown command " + verb;
}

// Cuts the network for a while, in all of the bus's domains: what arrives and what is sent is
// dropped. From outside of the process it would take root.
void CutOff(Bus& bus, milliseconds duration) {
  const Bus::Impl& impl = bus.impl();
  for (const Entity* domain : {&impl.main_domain, &impl.batch_domain, &impl.operate_domain}) {
    if (!*domain) continue;
    const dds_return_t result = dds_domain_set_deafmute(domain->get(), /*deaf=*/true, /*mute=*/true,
                                                        DDS_MSECS(duration.count()));
    CHECK(result == DDS_RETCODE_OK) << dds_strretcode(-result);
  }
}

void Serve(Bus& bus) {
  Endpoints endpoints = AllEndpoints();
  std::unique_ptr<Answerer> answerer;
  for (std::string line; std::getline(std::cin, line) && line != "quit";) {
    std::istringstream words(line);
    std::string verb, name;
    words >> verb;
    if (verb == "answer") {
      answerer = std::make_unique<Answerer>(bus);
      Say("ok");
    } else if (verb == "roundtrip") {
      uint64_t count = 0, bytes = 0;
      words >> count >> bytes;
      Say(RoundTrip(bus, count, bytes));
    } else if (verb == "deafmute") {
      int64_t duration = 0;
      words >> duration;
      CutOff(bus, milliseconds(duration));
      Say("ok");
    } else {
      words >> name;
      Say(RunTyped(verb, words, bus, *endpoints.at(name)));
    }
  }
}

std::unique_ptr<Bus> Join(const std::vector<std::string>& arguments) {
  static const std::map<std::string, Role> kRoles = {{"coordinator", Role::kCoordinator},
                                                     {"learner", Role::kLearner},
                                                     {"replay", Role::kReplay},
                                                     {"actor", Role::kActor},
                                                     {"eval", Role::kEval},
                                                     {"client", Role::kClient}};
  ClusterAddress address;
  std::unique_ptr<Bus> bus;
  const size_t count = arguments.size();
  if ((count == 1 || count == 2) && arguments[0] == "claim") {
    if (count == 2) address.secure = arguments[1];
    bus = ClaimDomain(TransportConfig{}, &address);
    Say(fmt::format("joined {} {}", address.domain, address.tag));
  } else if ((count == 3 || count == 4) && kRoles.contains(arguments[0])) {
    if (count == 4) address.secure = arguments[3];
    address.domain = std::stoi(arguments[1]);
    address.tag = arguments[2];
    bus = std::make_unique<Bus>(address, TransportConfig{}, kRoles.at(arguments[0]));
    Say("joined");
  } else {
    throw UsageError("usage: dds_peer ROLE DOMAIN TAG [SECURE] | dds_peer claim [SECURE]");
  }
  return bus;
}

int Run(int argc, char** argv) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  TuneMalloc();
  const std::unique_ptr<Bus> bus = Join({argv + 1, argv + argc});
  Serve(*bus);
  return 0;
}

}  // namespace
}  // namespace shoal::dds

int main(int argc, char** argv) {
  return shoal::GuardMain("dds_peer", [&] { return shoal::dds::Run(argc, argv); });
}
