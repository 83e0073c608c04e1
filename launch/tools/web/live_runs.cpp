// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/live_runs.h"

#include <algorithm>

#include "common/base/error.h"
#include "launch/watch/run_target.h"

namespace shoal::launch {
namespace {

constexpr std::chrono::seconds kSilent{10};  // longest time without a view from a coordinator

}  // namespace

std::shared_ptr<LiveRuns::Line> LiveRuns::LineTo(const std::filesystem::path& run) {
  const MutexLock lock(mutex_);
  auto it = lines_.find(run);
  if (it == lines_.end()) {
    if (lines_.size() >= kMost) {
      lines_.erase(std::ranges::min_element(lines_, {},
                                            [](const auto& line) { return line.second->asked; }));
    }
    it = lines_.emplace(run, std::make_shared<Line>()).first;
  }
  it->second->asked = Now();
  return it->second;
}

RunClient& LiveRuns::Client(const std::filesystem::path& run, Line& line) {
  // Resolve a joined run again, too: it may have ended, and another run begun in its folder.
  TargetOptions options{.run = run.string(), .peer = "", .secure = secure_};
  RunTarget target;
  try {
    target = ResolveTarget(options);
  } catch (const Error&) {
    line.connection.reset();
    line.view.reset();
    throw;
  }
  if (!line.connection) line.connection = std::make_unique<RunConnection>(target);
  return line.connection->client();
}

RunViewMessage LiveRuns::View(const std::filesystem::path& run) {
  const std::shared_ptr<Line> line = LineTo(run);
  const MutexLock lock(line->mutex);
  RunClient& client = Client(run, *line);
  auto fresh = line->view ? client.WaitForView(Now()) : std::optional(client.FirstView());
  if (fresh) {
    line->view = std::move(fresh);
    line->heard = Now();
  }
  if (Now() - line->heard > kSilent || line->view->state == "ended") {
    const bool ended = line->view->state == "ended";
    line->connection.reset();
    line->view.reset();
    throw RuntimeError("run '{}': {}", run.filename().string(),
                       ended ? "it has ended" : "its coordinator is silent");
  }
  return *line->view;
}

ReplyMessage LiveRuns::Order(const std::filesystem::path& run, const std::string& verb,
                             const std::vector<std::string>& arguments) {
  const std::shared_ptr<Line> line = LineTo(run);
  const MutexLock lock(line->mutex);
  return Client(run, *line).Order(verb, arguments);
}

void LiveRuns::LeaveUnwatched(SteadyTime now) {
  std::vector<std::shared_ptr<Line>> left;  // destroyed after the lock's release
  const MutexLock lock(mutex_);
  for (auto it = lines_.begin(); it != lines_.end();) {
    if (now - it->second->asked > kUnwatched) {
      left.push_back(std::move(it->second));
      it = lines_.erase(it);
    } else {
      ++it;
    }
  }
}

size_t LiveRuns::size() const {
  const MutexLock lock(mutex_);
  return lines_.size();
}

}  // namespace shoal::launch
