#include "launch/run_client.h"

#include <algorithm>
#include <utility>

#include "common/base/error.h"
#include "common/base/stop.h"

namespace shoal::launch {
namespace {

constexpr std::chrono::milliseconds kPoll{100};  // between looks at stop signals

}  // namespace

RunClient::RunClient(const RunTarget& target)
    : target_(target),
      bus_(target.address, target.transport, dds::Role::kClient),
      views_(bus_, [this](const RunViewMessage& view) {
        const MutexLock lock(mutex_);
        view_ = view;
        arrived_.NotifyAll();
      }) {}

std::optional<RunViewMessage> RunClient::WaitForView(SteadyTime deadline) {
  const MutexLock lock(mutex_);
  while (!view_ && Now() < deadline && !StopRequested()) {
    arrived_.WaitUntil(mutex_, std::min(deadline, Now() + kPoll));
  }
  return std::exchange(view_, std::nullopt);
}

RunViewMessage RunClient::FirstView() {
  if (auto view = WaitForView(Now() + kAnswer)) return *std::move(view);
  throw RuntimeError("run '{}': its coordinator at {}:{} did not answer within {} s", target_.name,
                     target_.address.host, dds::OperatePort(target_.address), kAnswer.count());
}

}  // namespace shoal::launch
