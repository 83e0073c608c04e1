// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/film_program.h"

#include "common/base/error.h"
#include "launch/processes/child_process.h"
#include "launch/processes/process_plan.h"
#include "launch/processes/scratch_folder.h"

namespace shoal::launch {
namespace {

constexpr char kShoal[] = "shoal";
// Same limits as for an evaluation with frames (actor_program.cpp).
constexpr std::chrono::seconds kFilmStart{60}, kFilmedEpisode{600};

}  // namespace

bool FilmByCommand(const FilmCommand& command, const std::function<bool()>& stop,
                   const std::function<void(const std::string&)>& say) {
  const ScratchFolder scratch;
  ProcessSpec spec = ProgramSpec(
      kShoal,
      {"film", command.checkpoint.string(), "--episodes", std::to_string(command.episodes),
       "--seed", std::to_string(command.seed), "--output", command.output.string()},
      1);
  spec.output = scratch.path() / "output";
  spec.errors = scratch.path() / "errors";
  std::string said;
  const auto report = [&] {
    std::string line = LastLine(spec.errors);
    // Error lines are reported by the exception, and interruptions by the caller.
    if (line.empty() || line == said || line.starts_with("shoal: ")) return;
    said = std::move(line);
    say(said);
  };
  const std::chrono::seconds deadline = kFilmStart + command.episodes * kFilmedEpisode;
  const auto status = RunToEnd(spec, deadline, [&] {
    report();
    return stop();
  });
  if (!status && stop()) return false;
  if (!status) {
    throw RuntimeError("filming '{}' took more than {} s", command.checkpoint.string(),
                       deadline.count());
  }
  if (!status->Clean()) throw ProgramError(kShoal, *status, spec.errors);
  report();
  return true;
}

}  // namespace shoal::launch
