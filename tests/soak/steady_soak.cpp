// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/steady_soak.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/base/clock.h"
#include "common/base/stop.h"
#include "tests/soak/leftovers.h"
#include "tests/soak/run_under_test.h"
#include "tests/soak/trend.h"

namespace shoal::soak {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;

constexpr seconds kLook{5};
constexpr double kMostPercent = 1, kErrors = 3;
constexpr double kMostMegabytesPerHour = 5;
constexpr double kLeastWarmUpSeconds = 120;

double ResidentMegabytesOf(pid_t pid) {
  std::ifstream statm("/proc/" + std::to_string(pid) + "/statm");
  double total = 0, resident = 0;
  statm >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

double EntriesOf(const fs::path& folder) {
  std::error_code error;
  double entries = 0;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    ++entries;
  }
  return entries;
}

double LogMegabytes(const fs::path& run) {
  double bytes = static_cast<double>(fs::file_size(run / "metrics.jsonl"));
  for (const char* folder : {"logs", "tensorboard"}) {
    for (const auto& entry : fs::directory_iterator(run / folder)) {
      bytes += static_cast<double>(entry.file_size());
    }
  }
  return bytes / 1e6;
}

using Trends = std::map<std::string, Trend>;

void Look(RunUnderTest* run, double now, Trends* trends) {
  std::vector<std::string> names = run->ProcessNames();
  names.push_back("coordinator");
  for (const std::string& name : names) {
    const pid_t pid = run->Pid(name);
    if (pid == 0) throw Broken(name + " is not there");
    const fs::path proc = "/proc/" + std::to_string(pid);
    (*trends)[name + " resident MB"].Add(now, ResidentMegabytesOf(pid));
    (*trends)[name + " open files"].Add(now, EntriesOf(proc / "fd"));
    (*trends)[name + " threads"].Add(now, EntriesOf(proc / "task"));
  }
  for (const auto& [figure, value] : run->QueueDepths()) (*trends)[figure].Add(now, value);
}

}  // namespace

nlohmann::ordered_json SoakSteadily(const SoakOptions& options, double minutes) {
  const auto shared_memory = SharedMemoryObjects();
  const double measured = 60 * minutes, warm_up = std::max(kLeastWarmUpSeconds, measured / 4);
  Trends trends;
  Trend logs;
  nlohmann::json meta;
  fs::path path, temporary_files;
  {
    RunUnderTest run({.folder = options.folder,
                      .programs = options.programs,
                      .actors = options.actors,
                      .seed = static_cast<int64_t>(options.seed),
                      .preset = options.preset,
                      .environment = options.environment,
                      .keys = options.keys});
    path = run.path();
    temporary_files = run.temporary_files();
    const SteadyTime start = Now();
    for (int looks = 1; SecondsSince(start) < warm_up + measured; ++looks) {
      run.CheckAlive();
      run.TakeProgress();
      const double now = SecondsSince(start);
      if (now > warm_up) {
        Look(&run, now, &trends);
        logs.Add(now, LogMegabytes(path));
      }
      while (Now() < start + looks * kLook && !StopRequested()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
    }
    meta = run.End(seconds(180));
  }
  CheckNothingIsLeft(path, temporary_files, shared_memory);

  nlohmann::ordered_json result{
      {"schema", "shoal-steady-1"},      {"minutes", minutes},
      {"warm_up_minutes", warm_up / 60}, {"env_steps", meta.at("env_steps")},
      {"updates", meta.at("updates")},   {"log_megabytes_per_hour", logs.Slope() * 3600}};
  nlohmann::ordered_json& broken = result["broken"] = nlohmann::ordered_json::array();
  for (const auto& [figure, trend] : trends) {
    const double percent = trend.PercentPerTenMinutes(), error = trend.PercentError();
    result["trends"][figure] = {
        {"mean", trend.Mean()}, {"percent_per_ten_minutes", percent}, {"standard_error", error}};
    if (percent > kMostPercent && percent > kMostPercent + kErrors * error) {
      broken.push_back(
          fmt::format("{} grows by {:.2f} % (+- {:.2f}) in ten minutes", figure, percent, error));
    }
  }
  if (logs.Slope() * 3600 > kMostMegabytesPerHour) {
    broken.push_back(
        fmt::format("logs and metrics grow by {:.1f} MB an hour", logs.Slope() * 3600));
  }
  return result;
}

}  // namespace shoal::soak
