// Where a run meets those who watch it: shows the whole run once a second on a DDS topic of its own
// (docs/monitoring.md).
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/dds/publisher.h"
#include "common/wire/messages.h"

namespace shoal::launch {

// Lives from the run's start until after its last evaluation. One thread.
class OperatorDesk {
 public:
  // Borrows the coordinator's bus.
  OperatorDesk(dds::Bus& bus, const std::string& run);
  // Gives watchers a moment to get the last view.
  ~OperatorDesk();
  OperatorDesk(const OperatorDesk&) = delete;
  OperatorDesk& operator=(const OperatorDesk&) = delete;

  // A line for people; watchers get the last kEvents.
  void AddEvent(const std::string& text);

  // Whether the next view is due.
  bool Due(SteadyTime now) const { return !shown_ || now - *shown_ >= kPeriod; }
  // Shows `view`, with name, time and events filled in.
  void Show(RunViewMessage view, SteadyTime now);
  // Shows the figures of the last view again, when due, in another state: no process is left.
  void ShowAgain(const std::string& state, SteadyTime now);
  // The last view: state "ended", with the coordinator's figure `exit_code`.
  void ShowEnd(int exit_code);

  static constexpr std::chrono::seconds kPeriod{1};
  static constexpr size_t kEvents = 50;

 private:
  void Publish(SteadyTime now);

  dds::Publisher<RunViewMessage> publisher_;
  std::deque<RunEvent> events_;
  uint64_t last_event_ = 0;
  RunViewMessage view_;
  std::optional<SteadyTime> shown_;
};

}  // namespace shoal::launch
