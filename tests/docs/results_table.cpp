// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/results_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "launch/tools/experiment/seed_figures.h"
#include "launch/tools/experiment/statistics.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using launch::Interval;
using launch::SeedFigures;

constexpr char kSchema[] = "shoal-results-1";
constexpr std::string_view kBegin = "<!-- results -->\n", kEnd = "<!-- end of results -->";
constexpr char kBusy[] = "†";

Json ReadObject(const fs::path& file) {
  Json object = ParseBoundedJson<Json>(ReadFile(file));
  if (!object.is_object()) throw RuntimeError("'{}': expected a JSON object", file.string());
  return object;
}

// Smallest and largest value of a figure over the seeds.
struct Range {
  double low = 0, high = 0;
};

struct Figures {
  SeedFigures seeds;
  std::vector<double> env_steps, wall_seconds, cores;
};

std::vector<std::string> Names(const Json& row, const char* key) {
  return row.value(key, std::vector<std::string>());
}

// "FILE" has the aggregate of an evaluation; "FILE#MEMBER" a member with the same figures, also of
// a list: "FILE#evaluations/9".
void AddEvaluation(const fs::path& folder, const std::string& name, SeedFigures* seeds) {
  const size_t hash = name.find('#');
  const Json file = ReadObject(folder / name.substr(0, hash));
  const std::string member = hash == std::string::npos ? "aggregate" : name.substr(hash + 1);
  const Json& figures = file.at(Json::json_pointer("/" + member));
  const auto number = [&](const char* key) -> std::optional<double> {
    if (!figures.contains(key) || figures.at(key).is_null()) return std::nullopt;
    return figures.at(key).get<double>();
  };
  seeds->Add(number("success_rate"), figures.at("episodes").get<size_t>(),
             number("return_mean").value_or(0), number("final_distance_mean"));
}

void AddMeta(const Json& meta, Figures* figures) {
  figures->env_steps.push_back(meta.at("env_steps").get<double>());
  figures->wall_seconds.push_back(meta.at("wall_seconds").get<double>());
  figures->cores.push_back(meta.at("machine").at("cores").get<double>());
}

const Json& ArmOf(const Json& summary, const std::string& name) {
  for (const Json& arm : summary.at("arms")) {
    if (arm.at("name") == name) return arm;
  }
  throw RuntimeError("the summary has no arm '{}'", name);
}

// Finished runs of an arm. Evaluations of the row, if it has some, replace those of the summary.
void AddArm(const Json& arm, bool evaluations, bool metas, Figures* figures) {
  for (const Json& run : arm.at("runs")) {
    if (run.at("status") != "finished") continue;
    if (!evaluations) {
      const Json& success = run.at("success");
      figures->seeds.Add(success.is_null() ? std::nullopt : std::optional(success.get<double>()),
                         run.at("episodes").get<size_t>(), run.at("return_mean").get<double>(),
                         std::nullopt);
    }
    if (metas) continue;
    figures->env_steps.push_back(run.at("env_steps").get<double>());
    figures->wall_seconds.push_back(run.at("wall_seconds").get<double>());
    figures->cores.push_back(run.at("cores").get<double>());
  }
}

Figures FiguresOf(const fs::path& folder, const Json& row) {
  Figures figures;
  const std::vector<std::string> evals = Names(row, "evals"), metas = Names(row, "metas");
  for (const std::string& name : evals) AddEvaluation(folder, name, &figures.seeds);
  for (const std::string& name : metas) AddMeta(ReadObject(folder / name), &figures);
  if (row.contains("summary")) {
    const Json summary = ReadObject(folder / row.at("summary").get<std::string>());
    AddArm(ArmOf(summary, row.at("arm").get<std::string>()), !evals.empty(), !metas.empty(),
           &figures);
  }
  if (row.contains("wall")) {
    const Json meta = ReadObject(folder / row.at("wall").get<std::string>());
    figures.wall_seconds = {meta.at("wall_seconds").get<double>()};
    figures.cores = {meta.at("machine").at("cores").get<double>()};
  }
  if (row.contains("cores")) figures.cores = {row.at("cores").get<double>()};
  if (figures.seeds.returns.empty() || figures.env_steps.empty()) {
    throw RuntimeError("expected evaluations and env steps of at least one run");
  }
  return figures;
}

Range RangeOf(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  return {low, high};
}

std::string Grouped(double value) {
  std::string digits = fmt::format("{:.0f}", std::abs(value));
  for (int i = static_cast<int>(digits.size()) - 3; i > 0; i -= 3) digits.insert(i, 1, ',');
  return (value < 0 ? "−" : "") + digits;
}

// Three significant digits.
double Rounded(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(std::max(value, 1.0))) - 2);
  return std::round(value / unit) * unit;
}

std::string StepsText(const Range& steps) {
  const std::string low = Grouped(Rounded(steps.low)), high = Grouped(Rounded(steps.high));
  return low == high ? low : fmt::format("{}–{}", low, high);
}

std::string WallText(const Range& seconds) {
  struct Unit {
    double seconds;
    const char* name;
  };
  const Unit unit =
      seconds.high < 180 ? Unit{1, "s"} : (seconds.high < 7200 ? Unit{60, "min"} : Unit{3600, "h"});
  const auto text = [&](double value) {
    return fmt::format("{:.{}f}", value / unit.seconds, unit.seconds > 60 ? 1 : 0);
  };
  const std::string low = text(seconds.low), high = text(seconds.high);
  return fmt::format("{} {}", low == high ? low : fmt::format("{}–{}", low, high), unit.name);
}

std::string CoresText(const Range& cores) {
  if (cores.low != cores.high) return fmt::format("{:.0f}–{:.0f} cores", cores.low, cores.high);
  return fmt::format("{:.0f} core{}", cores.low, cores.low == 1 ? "" : "s");
}

// "100", "96.4": no digit behind the point for whole numbers of percent at the ends.
std::string Percent(double rate) {
  const std::string text = fmt::format("{:.1f}", 100 * rate);
  return text.ends_with(".0") && (rate <= 0.0005 || rate >= 0.9995)
             ? text.substr(0, text.size() - 2)
             : text;
}

std::string SuccessText(const SeedFigures& seeds) {
  const Interval interval = seeds.successes.size() > 1
                                ? *launch::SuccessInterval95(seeds.successes)
                                : launch::Wilson95(seeds.Successes(), seeds.Episodes());
  return fmt::format("**{} %** ({}–{})", Percent(launch::Mean(seeds.Rates())),
                     Percent(interval.low), Percent(interval.high));
}

std::string ReturnText(const SeedFigures& seeds) {
  const std::string mean = Grouped(launch::Mean(seeds.returns));
  const std::optional<Interval> interval = launch::MeanInterval95(seeds.returns);
  if (!interval) return fmt::format("return **{}**", mean);
  return fmt::format("return **{}** ({} to {})", mean, Grouped(interval->low),
                     Grouped(interval->high));
}

std::string RowText(const fs::path& folder, const Json& row) {
  const Figures figures = FiguresOf(folder, row);
  const SeedFigures& seeds = figures.seeds;
  const auto text = [&](const char* key) { return row.at(key).get<std::string>(); };
  return fmt::format("| [{}](results/{}) | {} | {} | {} | {} | {}{}, {} | {} | {} |\n",
                     text("task"), text("page"), text("preset"), text("input"),
                     seeds.successes.empty() ? ReturnText(seeds) : SuccessText(seeds),
                     StepsText(RangeOf(figures.env_steps)), WallText(RangeOf(figures.wall_seconds)),
                     row.value("busy", false) ? kBusy : "", CoresText(RangeOf(figures.cores)),
                     seeds.returns.size(), text("privileged"), text("page"));
}

}  // namespace

std::string ResultsTables(const fs::path& folder) {
  const fs::path file = folder / "table.json";
  const Json table = ReadObject(file);
  if (table.value("schema", "") != kSchema) {
    throw RuntimeError("'{}': expected schema {}", file.string(), kSchema);
  }
  std::string text;
  for (const Json& group : table.at("groups")) {
    text += fmt::format(
        "\n### {}\n\n| task | preset | input of the policy | success or return (95 %) | env steps "
        "| "
        "wall clock | seeds | privileged in training |\n| --- | --- | --- | --- | --- | --- | "
        "--- | --- |\n",
        group.at("title").get<std::string>());
    for (const Json& row : group.at("rows")) {
      try {
        text += RowText(folder, row);
      } catch (const std::exception& e) {
        throw RuntimeError("{}, row '{}': {}", file.string(), row.value("preset", "without preset"),
                           e.what());
      }
    }
  }
  return text + "\n";
}

std::string WithResults(std::string_view page, std::string_view tables) {
  const size_t begin = page.find(kBegin), end = page.find(kEnd);
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin) {
    throw RuntimeError("the page has no lines '{}' and '{}'", kBegin.substr(0, kBegin.size() - 1),
                       kEnd);
  }
  return fmt::format("{}{}{}", page.substr(0, begin + kBegin.size()), tables, page.substr(end));
}

}  // namespace shoal
