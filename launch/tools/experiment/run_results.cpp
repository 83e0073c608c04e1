// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/run_results.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/config/run_files.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/first_reached.h"
#include "launch/record/json_fields.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void ReadMeta(const json& meta, RunResults* results) {
  results->exit = TextOrEmpty(meta, "exit");
  results->error = TextOrEmpty(meta, "error");
  results->started = TextOrEmpty(meta, "started");
  results->finished = TextOrEmpty(meta, "finished");
  results->precision = TextOrEmpty(meta, "precision");
  meta.at("env_steps").get_to(results->env_steps);
  meta.at("updates").get_to(results->updates);
  meta.at("wall_seconds").get_to(results->wall_seconds);
  results->cpu_seconds = NumberOrNothing(meta, "cpu_seconds");
  results->energy_wh = NumberOrNothing(meta, "energy_wh");
  if (meta.contains("commits")) {
    meta.at("commits").get_to(results->commits);
  } else {
    results->commits = {TextOrEmpty(meta, "commit")};  // runs of older builds have one commit
  }
  if (const auto machine = meta.find("machine"); machine != meta.end()) {
    results->cpu = TextOrEmpty(*machine, "cpu");
    results->cores = machine->value("cores", 0);
  }
}

// Reads the files in eval/ of a run whose names begin with `start`, sorted by name.
std::vector<EvaluationFigures> ReadAll(const fs::path& run, const std::string& start) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(run / kEvaluationFolder, error), end; !error && it != end;
       it.increment(error)) {
    const std::string name = it->path().filename();
    if (name.starts_with(start) && name.ends_with(".json")) files.push_back(it->path());
  }
  std::ranges::sort(files);
  std::vector<EvaluationFigures> all;
  all.reserve(files.size());
  for (const fs::path& file : files) all.push_back(ReadEvaluationFigures(file));
  return all;
}

}  // namespace

fs::path NamedFolder(const fs::path& folder) {
  const fs::path canonical = fs::weakly_canonical(folder);
  return canonical.has_filename() ? canonical : canonical.parent_path();
}

std::optional<double> RunResults::Objective() const {
  if (!final) return std::nullopt;
  return final->success ? *final->success : final->return_mean;
}

RunResults ReadRunResults(const fs::path& run) {
  RunResults results{.folder = NamedFolder(run), .config = ReadRunConfig(run).config};
  results.name = results.folder.filename();
  const fs::path meta = run / kMetaFile;
  if (fs::exists(meta)) {
    const json object = ParseStrictJson(ReadFile(meta), meta);
    try {
      ReadMeta(object, &results);
    } catch (const json::exception& e) {
      throw RuntimeError("{}: {}", meta.string(), e.what());
    }
  }
  results.curve = ReadAll(run, kEvaluationPrefix);  // padded names: the order is that of env steps
  results.transfer = ReadAll(run, kTransferPrefix);
  if (const fs::path final = run / kEvaluationFolder / kFinalEvaluationFile; fs::exists(final)) {
    results.final = ReadEvaluationFigures(final);
  }
  return results;
}

const EvaluationFigures* FirstReaching(const RunResults& run, double success) {
  std::vector<EvaluatedSuccess> successes;
  for (const EvaluationFigures& point : run.curve) {
    successes.push_back({point.success, point.episodes});
  }
  const auto first =
      FirstReached(successes, success, static_cast<size_t>(run.config.stop.evaluations));
  return first ? &run.curve[*first] : nullptr;
}

std::optional<uint64_t> StepsToSuccess(const RunResults& run, double success) {
  const EvaluationFigures* first = FirstReaching(run, success);
  return first == nullptr ? std::nullopt : std::optional(first->env_steps);
}

}  // namespace shoal::launch
