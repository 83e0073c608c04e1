// SPDX-License-Identifier: Apache-2.0
#include "launch/run/working_actors.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>

namespace shoal::launch {
namespace {

constexpr size_t kNamed = 2;  // actors named in a message

std::string Describe(const DownProcess& process) {
  const std::string next = process.restart_in
                               ? fmt::format("next try in {} s", process.restart_in->count())
                               : "being tried again";
  return fmt::format("{}: {} (death {}, {})", process.name, process.reason, process.deaths, next);
}

std::string Describe(const std::vector<DownProcess>& down) {
  std::string text;
  for (size_t i = 0; i < std::min(down.size(), kNamed); ++i) {
    text += (i == 0 ? "" : "; ") + Describe(down[i]);
  }
  if (down.size() > kNamed) text += fmt::format("; and {} more", down.size() - kNamed);
  return text;
}

}  // namespace

std::optional<std::string> WorkingActors::Look(const RoleStanding& actors,
                                               std::chrono::seconds patience, SteadyTime now) {
  ever_ |= actors.working > 0;
  // An actor that has not died may be starting, or may be waiting for other processes.
  if (actors.down.empty() || std::ssize(actors.down) < actors.processes) {
    without_.Heard(now);
    return std::nullopt;
  }
  const bool all_in_vain =
      std::ranges::none_of(actors.down, &std::string::empty, &DownProcess::hopeless);
  if (!ever_ && all_in_vain) {
    return fmt::format("{}: {}", actors.down[0].name, actors.down[0].hopeless);
  }
  if (without_.Look(now) <= patience) return std::nullopt;
  return fmt::format("no training actor has worked for {} s (stop.without_actors): {}",
                     patience.count(), Describe(actors.down));
}

std::optional<std::string> MissingEvaluations(const RoleStanding& evaluation, bool delivered) {
  if (delivered || evaluation.down.empty() || evaluation.down[0].hopeless.empty()) {
    return std::nullopt;
  }
  return fmt::format("{}: {}", evaluation.down[0].name, evaluation.down[0].hopeless);
}

std::string DescribeTrouble(const RoleStanding& actors, const RoleStanding& evaluation) {
  std::string text;
  if (!actors.down.empty()) {
    text = fmt::format("actors {} of {}: {}", actors.processes - std::ssize(actors.down),
                       actors.processes, Describe(actors.down));
  }
  if (!evaluation.down.empty()) {
    text += (text.empty() ? "" : "; ") + ("no evaluation actor: " + Describe(evaluation.down));
  }
  return text;
}

}  // namespace shoal::launch
