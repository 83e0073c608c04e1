// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/child_runs.h"

#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>
#include <numeric>
#include <sstream>

#include "common/base/check.h"
#include "common/base/files.h"
#include "common/base/main_guard.h"

namespace shoal::simulation {
namespace {

namespace fs = std::filesystem;

constexpr char kAnswer[] = "answer";

std::string TextOf(const Outcome& outcome, const std::vector<Fault>& faults) {
  std::string text;
  for (size_t i = 0; i < faults.size(); ++i) {
    text += fmt::format("  fault {}: {}\n", i, faults[i].Text());
  }
  for (const std::string& line : outcome.story) text += fmt::format("  {}\n", line);
  for (const std::string& line : outcome.violations) text += fmt::format("  ! {}\n", line);
  return text;
}

// Runs in the child. The lines of the answer are: the summary, whether the run was good, the
// simulated duration.
void Answer(const Blueprint& blueprint, uint64_t seed, const std::vector<Fault>& faults,
            bool with_story, const fs::path& folder) {
  const Outcome outcome = Simulate(blueprint, seed, faults, folder / "run");
  std::string text = fmt::format(
      "seed {}: {}, {:.1f} simulated s, {} session(s), {} switches, trace {:016x}\n{}\n{}\n", seed,
      outcome.good() ? "good" : "FAILED", outcome.seconds, outcome.sessions, outcome.switches,
      outcome.trace, outcome.good() ? "good" : "bad", outcome.seconds);
  if (with_story || !outcome.good()) text += TextOf(outcome, faults);
  WriteFileAtomically(folder / kAnswer, text);
}

pid_t StartRun(const Blueprint& blueprint, uint64_t seed, const std::vector<Fault>& faults,
               bool with_story, const fs::path& folder) {
  MakeFolders(folder);
  std::fflush(nullptr);
  const pid_t child = fork();
  CHECK(child >= 0) << "fork";
  if (child > 0) return child;
  const int code = GuardBody(
      "shoal-simulate",
      [&] {
        Answer(blueprint, seed, faults, with_story, folder);
        return 0;
      },
      [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); });
  _exit(code);
}

ChildRun End(uint64_t seed, int status, const fs::path& folder) {
  ChildRun run{.seed = seed, .good = false, .simulated_seconds = 0, .text = {}, .summary = {}};
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    std::istringstream answer(ReadFile(folder / kAnswer));
    std::string verdict, seconds;
    std::getline(answer, run.summary);
    std::getline(answer, verdict);
    std::getline(answer, seconds);
    run.good = verdict == "good";
    run.simulated_seconds = std::stod(seconds);
    run.text.assign(std::istreambuf_iterator<char>(answer), {});
  } else {
    run.summary = WIFEXITED(status)
                      ? fmt::format("seed {}: FAILED with exit code {}", seed, WEXITSTATUS(status))
                      : fmt::format("seed {}: FAILED by signal {}", seed, WTERMSIG(status));
  }
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  return run;
}

// In memory where there is such a folder.
fs::path Scratch() {
  std::error_code error;
  return fs::is_directory("/dev/shm", error) ? fs::path("/dev/shm") : fs::temp_directory_path();
}

}  // namespace

void RunInChildren(const std::vector<Blueprint>& blueprints, int jobs, bool with_story,
                   const std::function<uint64_t()>& next,
                   const std::function<std::vector<Fault>(uint64_t seed)>& faults,
                   const std::function<void(const ChildRun&)>& done) {
  const fs::path base = MakeFreshFolder("shoal-simulate-", Scratch());
  const auto folder_of = [&](uint64_t seed) { return base / std::to_string(seed); };
  std::map<pid_t, uint64_t> running;
  bool more = true;
  while (more || !running.empty()) {
    while (more && std::cmp_less(running.size(), jobs)) {
      const uint64_t seed = next();
      more = seed != 0;
      if (!more) break;
      running[StartRun(BlueprintOf(seed, blueprints), seed, faults(seed), with_story,
                       folder_of(seed))] = seed;
    }
    if (running.empty()) break;
    int status = 0;
    const auto ended = running.find(waitpid(-1, &status, 0));
    if (ended == running.end()) continue;
    const uint64_t seed = ended->second;
    running.erase(ended);
    done(End(seed, status, folder_of(seed)));
  }
  std::error_code ignored;
  fs::remove_all(base, ignored);
}

ChildRun RunInChild(const std::vector<Blueprint>& blueprints, uint64_t seed,
                    const std::vector<Fault>& faults) {
  ChildRun result;
  bool begun = false;
  RunInChildren(
      blueprints, 1, /*with_story=*/true, [&] { return std::exchange(begun, true) ? 0 : seed; },
      [&](uint64_t) { return faults; }, [&](const ChildRun& run) { result = run; });
  return result;
}

std::vector<size_t> ShortenedSchedule(const std::vector<Blueprint>& blueprints, uint64_t seed,
                                      const std::vector<Fault>& faults) {
  std::vector<size_t> kept(faults.size());
  std::iota(kept.begin(), kept.end(), 0);
  for (size_t i = 0; i < faults.size(); ++i) {
    std::vector<size_t> fewer = kept;
    std::erase(fewer, i);
    std::vector<Fault> some;
    for (const size_t number : fewer) some.push_back(faults[number]);
    if (!RunInChild(blueprints, seed, some).good) kept = fewer;
  }
  return kept;
}

}  // namespace shoal::simulation
