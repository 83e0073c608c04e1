#include "launch/operator_desk.h"

namespace shoal::launch {
namespace {

constexpr std::chrono::milliseconds kFarewell{1000};

}  // namespace

OperatorDesk::OperatorDesk(dds::Bus& bus, const std::string& run) : publisher_(bus) {
  view_.run = run;
}

OperatorDesk::~OperatorDesk() {
  if (publisher_.Matched() > 0) publisher_.WaitForAcks(kFarewell);
}

void OperatorDesk::AddEvent(const std::string& text) {
  events_.push_back({.number = ++last_event_, .time = WallTimeSeconds(), .text = text});
  if (events_.size() > kEvents) events_.pop_front();
}

void OperatorDesk::Show(RunViewMessage view, SteadyTime now) {
  view.run = view_.run;
  view_ = std::move(view);
  Publish(now);
}

void OperatorDesk::ShowAgain(const std::string& state, SteadyTime now) {
  if (!Due(now) && view_.state == state) return;
  view_.state = state;
  std::erase_if(view_.processes, [](const auto& process) { return process.role != "coordinator"; });
  for (MetricsMessage& process : view_.processes) process.state = state;
  Publish(now);
}

void OperatorDesk::ShowEnd(int exit_code) {
  ShowAgain("ended", Now());
  for (MetricsMessage& process : view_.processes) {
    process.names.push_back("exit_code");
    process.values.push_back(exit_code);
  }
  Publish(Now());
}

void OperatorDesk::Publish(SteadyTime now) {
  view_.time = WallTimeSeconds();
  view_.events = {events_.begin(), events_.end()};
  if (publisher_.Write(view_)) shown_ = now;
}

}  // namespace shoal::launch
