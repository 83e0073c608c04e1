// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/report.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/base/build_info.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/escape_markup.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/run_folder.h"
#include "launch/tools/experiment/frames_table.h"
#include "launch/tools/experiment/statistics_json.h"
#include "launch/tools/experiment/summary.h"
#include "launch/tools/report/command_line.h"
#include "launch/tools/report/curves.h"
#include "launch/tools/report/report_curves.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr double kUsualTarget = 0.9;
constexpr uintmax_t kLargestFilm = 2'000'000;  // bytes; a larger page would be too large to send

constexpr char kStyle[] = R"(
body { font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #222; max-width: 76rem;
       margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.7rem; margin-bottom: .2rem; } h2 { font-size: 1.2rem; margin-top: 2rem; }
.question { font-size: 1.05rem; color: #444; max-width: 48rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .9rem; }
th, td { text-align: left; padding: .3rem .8rem .3rem 0; border-bottom: 1px solid #ddd;
         vertical-align: top; }
th { color: #555; font-weight: 600; white-space: nowrap; }
code, pre { font: .85rem/1.45 "DejaVu Sans Mono", monospace; }
pre { background: #f5f5f5; padding: .8rem; overflow-x: auto; }
.note { color: #666; font-size: .85rem; } svg { max-width: 100%; height: auto; }
video { width: 32rem; max-width: 100%; }
)";

using Row = TableRow;

std::string RowHtml(const Row& row, const char* cell) {
  std::string html = "<tr>";
  for (const std::string& text : row)
    html += fmt::format("<{0}>{1}</{0}>", cell, EscapeMarkup(text));
  return html + "</tr>\n";
}

std::string TableHtml(const Row& head, const std::vector<Row>& rows) {
  std::string html = "<div class=\"scroll\"><table>\n" + RowHtml(head, "th");
  for (const Row& row : rows) html += RowHtml(row, "td");
  return html + "</table></div>\n";
}

// Leaves out columns that are empty in all rows, for example for a task without success or goals.
std::string TableHtmlOfFilled(Row head, std::vector<Row> rows) {
  for (size_t column = head.size(); column-- > 0;) {
    const auto at = static_cast<std::ptrdiff_t>(column);
    if (!std::ranges::all_of(rows, [&](const Row& row) { return row[column] == "-"; })) continue;
    head.erase(head.begin() + at);
    for (Row& row : rows) row.erase(row.begin() + at);
  }
  return TableHtml(head, rows);
}

std::string Section(const std::string& title, const std::string& body) {
  return body.empty() ? "" : fmt::format("<h2>{}</h2>\n{}", EscapeMarkup(title), body);
}

std::string ResultsHtml(const Comparison& comparison) {
  std::vector<Row> rows;
  for (size_t i = 0; i < comparison.groups.size(); ++i) {
    const GroupFigures& group = comparison.groups[i];
    std::string ratio = i == 0 ? "1" : "-";
    if (i > 0 && !comparison.ratios[i - 1].pairs.empty()) {
      const std::string& first = comparison.groups[0].name;
      ratio = FormatMedian(comparison.ratios[i - 1]) + "; " +
              FormatPairs(comparison.ratios[i - 1], group.name, first);
    }
    const bool success = !group.figures.successes.empty();
    rows.push_back({group.name, FormatSeeds(group), FormatSuccess(group.figures),
                    FormatReturn(group.figures), FormatDistance(group.figures),
                    success ? FormatSteps(group) : "-", success ? ratio : "-"});
  }
  std::string html = TableHtmlOfFilled(
      {"", "seeds", "success [95 %]", "return [95 %]", "distance, cm [95 %]",
       fmt::format("env steps (wall clock) to {:.0f} %", 100 * comparison.target_success),
       "ratio to the first"},
      rows);
  const bool success = std::ranges::any_of(comparison.groups, [](const GroupFigures& group) {
    return !group.figures.successes.empty();
  });
  html +=
      success
          ? "<p class=\"note\">Success, return and distance: mean over seeds with Student's "
            "interval over seeds; that of success is never narrower than Wilson's of all episodes, "
            "which is the interval of a single seed. Env steps: at the first of the evaluations in "
            "a row whose episodes together reach the rate; a seed that did not get there, or "
            "failed, is counted, not dropped.</p>\n"
          : "<p class=\"note\">Return: mean over seeds, Student's interval.</p>\n";
  if (comparison.baselines) {
    html += fmt::format("<p>{} {}.</p>\n", EscapeMarkup(comparison.task),
                        EscapeMarkup(FormatBaselines(*comparison.baselines)));
  }
  std::vector<std::string> early, failed, missing;
  for (const GroupFigures& group : comparison.groups) {
    failed.insert(failed.end(), group.failed.begin(), group.failed.end());
    early.insert(early.end(), group.without_final.begin(), group.without_final.end());
    missing.insert(missing.end(), group.unevaluated.begin(), group.unevaluated.end());
  }
  if (!early.empty()) {
    html += EscapeMarkup(fmt::format("No final evaluation yet, so the last evaluation counts: {}.",
                                     fmt::join(early, ", ")));
  }
  if (!failed.empty()) {
    html += EscapeMarkup(fmt::format(" Failed: {}.", fmt::join(failed, ", ")));
  }
  if (!missing.empty()) {
    html += EscapeMarkup(fmt::format(" Missing: {}.", fmt::join(missing, ", ")));
  }
  return html;
}

std::string TableHtmlWithHead(std::vector<Row> rows) {
  const Row head = rows[0];
  rows.erase(rows.begin());
  return TableHtml(head, rows);
}

// Mean returns at environment frames, and the published ones.
std::string FramesHtml(const std::vector<FramesResults>& experiments) {
  std::string html;
  for (const FramesResults& results : experiments) {
    html += TableHtmlWithHead(FramesRows(results));
    html +=
        "<p class=\"note\">Mean return over seeds with Student's interval, of the evaluations "
        "during training that are nearest to these numbers of environment frames (env steps x "
        "action repeat) and within 2 % of them.</p>\n";
    for (const int64_t frames : PublishedFrames(results)) {
      html += fmt::format("<p>Reference {} at {} environment frames</p>\n",
                          EscapeMarkup(results.reference), frames);
      html += TableHtmlWithHead(PublishedRows(results, frames));
    }
  }
  return html;
}

// Sources of the references, and of their methods that have a source of their own.
std::string SourcesHtml(const ReportContent& content) {
  std::vector<std::string> lines = content.problems;
  for (const Reference& reference : content.references) {
    lines.push_back(
        fmt::format("Dashed lines: reference {}. {}", reference.name, reference.source));
    for (const ReferenceResult& result : reference.results) {
      if (result.source.empty()) continue;
      const std::string line = fmt::format("{}: {}", result.method, result.source);
      if (std::ranges::count(lines, line) == 0) lines.push_back(line);
    }
  }
  std::string html;
  for (const std::string& line : lines) {
    html += fmt::format("<p class=\"note\">{}</p>\n", EscapeMarkup(line));
  }
  return html;
}

// Results of policies on tasks other than their own.
std::string TransferHtml(const std::vector<RunGroup>& groups) {
  std::vector<Row> rows;
  for (const RunGroup& group : groups) {
    std::vector<std::string> tasks;
    for (const RunResults& run : group.runs) {
      for (const EvaluationFigures& figures : run.transfer) {
        if (std::ranges::count(tasks, figures.task) == 0) tasks.push_back(figures.task);
      }
    }
    for (const std::string& task : tasks) {
      SeedFigures figures;
      for (const RunResults& run : group.runs) {
        if (std::ranges::count(group.failed, run.name) > 0) continue;
        for (const EvaluationFigures& on : run.transfer) {
          if (on.task != task) continue;
          figures.Add(on.success, on.episodes, on.return_mean, on.final_distance_mean);
        }
      }
      figures.failed = group.failed.size();
      rows.push_back({group.name, group.runs[0].config.task, task, FormatReturn(figures),
                      FormatSuccess(figures)});
    }
  }
  if (rows.empty()) return "";
  return TableHtml({"", "trained on", "tested on", "return [95 %]", "success [95 %]"}, rows);
}

// {"learner.batch": 64} as "learner.batch = 64, ..."; "-" if nothing is set.
std::string FormatKeys(const nlohmann::ordered_json& set) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : set.items()) keys.push_back(key + " = " + value.dump());
  return keys.empty() ? "-" : fmt::format("{}", fmt::join(keys, ", "));
}

// Definitions of the experiments, which were fixed before the first run.
std::string DefinitionsHtml(const std::vector<Definition>& definitions) {
  std::string html;
  for (const Definition& definition : definitions) {
    std::vector<Row> rows{
        {"base", definition.base},
        {"every arm", FormatKeys(definition.set)},
        {"seeds", fmt::format("{}", fmt::join(definition.seeds, ", "))},
        {"final episodes",
         definition.final_episodes ? std::to_string(*definition.final_episodes) : "the base's"},
        {"target success", fmt::format("{:.0f} %", 100 * definition.target_success)}};
    for (const Arm& arm : definition.arms) rows.push_back({"arm " + arm.name, FormatKeys(arm.set)});
    if (!definition.transfer.empty()) {
      rows.push_back({"also tested on", fmt::format("{}", fmt::join(definition.transfer, ", "))});
    }
    if (!definition.frames.empty()) {
      rows.push_back({"returns at frames", fmt::format("{}", fmt::join(definition.frames, ", "))});
    }
    if (!definition.reference.empty()) rows.push_back({"reference", definition.reference});
    html += TableHtml({"experiment", definition.name}, rows);
  }
  return html;
}

// An optional number with a fixed number of digits after the point, else "-".
std::string NumberOrDash(const std::optional<double>& number, int digits) {
  return number ? fmt::format("{:.{}f}", *number, digits) : "-";
}

std::string RunsHtml(const std::vector<RunGroup>& groups) {
  std::vector<Row> rows;
  for (const RunGroup& group : groups) {
    for (const RunResults& run : group.runs) {
      rows.push_back({run.name, run.exit.empty() ? "-" : run.exit, std::to_string(run.env_steps),
                      std::to_string(run.updates), fmt::format("{:.0f}", run.wall_seconds),
                      fmt::format("{:.2f}", run.wall_seconds * run.cores / 3600),
                      NumberOrDash(run.cpu_seconds, 0), NumberOrDash(run.energy_wh, 2),
                      fmt::format("{} ({} cores)", run.cpu, run.cores), run.precision,
                      fmt::format("{}", fmt::join(run.commits, ", ")), run.started});
    }
  }
  return TableHtml({"run", "end", "env steps", "updates", "wall, s", "core-hours", "CPU, s",
                    "energy, Wh", "machine", "precision", "builds", "started (UTC)"},
                   rows);
}

std::string ConfigurationHtml(const ReportContent& content) {
  std::string html;
  if (!content.comparison.differences.empty()) {
    Row head{"different keys"};
    for (const GroupFigures& group : content.comparison.groups) head.push_back(group.name);
    std::vector<Row> rows;
    for (const KeyDifference& difference : content.comparison.differences) {
      rows.push_back({difference.key});
      std::ranges::copy(difference.values, std::back_inserter(rows.back()));
    }
    html += TableHtml(head, rows);
  }
  for (const RunGroup& group : content.groups) {
    if (group.runs.empty()) continue;
    html += fmt::format("<details><summary>every key of {}</summary><pre>{}</pre></details>\n",
                        EscapeMarkup(group.runs[0].name),
                        EscapeMarkup(ToJson(group.runs[0].config).dump(2)));
  }
  return html;
}

std::string Base64(const std::string& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    const size_t taken = std::min<size_t>(3, bytes.size() - i);
    for (size_t j = 0; j < 3; ++j) {
      group = group << 8 | (j < taken ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    }
    for (size_t j = 0; j < 4; ++j) {
      text += j <= taken ? kDigits[group >> (18 - 6 * j) & 63] : '=';
    }
  }
  return text;
}

// The first film of each group.
std::string FilmsHtml(const std::vector<RunGroup>& groups) {
  std::string html;
  for (const RunGroup& group : groups) {
    if (group.runs.empty()) continue;
    const std::vector<fs::path> films = FilmsOf(group.runs[0].folder);
    if (films.empty()) continue;
    html += fmt::format("<p>{}", EscapeMarkup(group.name));
    html += fs::file_size(films[0]) > kLargestFilm
                ? fmt::format(": {} is too large to be in this page</p>\n",
                              EscapeMarkup(films[0].string()))
                : fmt::format("</p><video controls src=\"data:video/mp4;base64,{}\"></video>\n",
                              Base64(ReadFile(films[0])));
  }
  return html;
}

std::string CommandsHtml(const std::vector<std::string>& commands) {
  return fmt::format("<pre>{}</pre>\n", EscapeMarkup(fmt::format("{}", fmt::join(commands, "\n"))));
}

// The SVG element without the document's prologue, which only a separate file may have.
std::string SvgElement(const std::string& document) {
  const size_t start = document.find("<svg");
  return start == std::string::npos ? "" : document.substr(start);
}

// Reads the experiment's returns at environment frames, and its reference.
void GatherFrames(const StoredExperiment& experiment, ReportContent* content) {
  if (!experiment.definition.frames.empty()) {
    content->frames.push_back(ReadOutcome(experiment).frames);
  }
  const std::string& name = experiment.definition.reference;
  if (name.empty() || std::ranges::count(content->references, name, &Reference::name) > 0) {
    return;
  }
  try {
    content->references.push_back(ReadReference(FindReference(name)));
  } catch (const Error& e) {
    content->problems.push_back(fmt::format("The reference is not shown: {}.", e.what()));
  }
}

}  // namespace

ReportContent GatherReport(const SubjectOptions& options, std::vector<Reference> references) {
  const Subjects subjects = ReadSubjects(options);
  ReportContent content{.groups = subjects.groups, .references = std::move(references)};
  double target = kUsualTarget;
  const bool single = subjects.named.size() == 1;
  if (!single) CheckOneTask(content.groups);
  for (const Subject& subject : subjects.named) {
    content.title += (content.title.empty() ? "" : ", ") + subject.name;
    if (!subject.experiment) continue;
    const Definition& definition = subject.experiment->definition;
    content.definitions.push_back(definition);
    GatherFrames(*subject.experiment, &content);
    content.commands.push_back(CommandLine({"shoal", "experiment", "run", definition.name}) +
                               "    # or the definition's file");
    if (single) {
      content.question = definition.question;
      target = definition.target_success;
    }
  }
  if (content.definitions.empty()) {
    for (const RunGroup& group : content.groups) {
      for (const RunResults& run : group.runs) {
        content.commands.push_back(TrainAgain(run.folder / kConfigFile, run.name));
      }
    }
  }
  content.comparison = Gather(content.groups, target);
  ReadRollouts(&content.groups);
  content.curves = DrawReportCurves(
      content.groups, {.over_frames = !content.frames.empty(), .references = content.references});
  return content;
}

std::string ReportHtml(const ReportContent& content) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>{0}</title><style>{1}</style>"
      "</head><body>\n<h1>{0}</h1>\n<p class=\"note\">{2} &middot; written {3} by shoal {4} ({5})"
      "</p>\n",
      EscapeMarkup(content.title), kStyle,
      EscapeMarkup(fmt::format("{}", fmt::join(TasksOf(content.groups), ", "))), UtcTimestamp(),
      BuildVersion(), BuildCommit());
  if (!content.question.empty()) {
    html += fmt::format("<p class=\"question\">{}</p>\n", EscapeMarkup(content.question));
  }
  html += Section("Definition", DefinitionsHtml(content.definitions));
  html += Section("Results", ResultsHtml(content.comparison));
  html += Section("Returns at environment frames", FramesHtml(content.frames));
  html += Section("On other tasks", TransferHtml(content.groups));
  if (!content.curves.empty()) {
    std::string drawings;
    for (const std::string& drawing : content.curves) drawings += SvgElement(drawing);
    html += Section("Learning curves",
                    drawings +
                        "<p class=\"note\">Mean over seeds; the band reaches from the smallest to "
                        "the largest seed. Thin lines: the actors' latest episodes, which "
                        "explore.</p>\n" +
                        SourcesHtml(content));
  }
  html += Section("Films", FilmsHtml(content.groups));
  html += Section("Runs", RunsHtml(content.groups));
  html += Section("Configuration", ConfigurationHtml(content));
  html += Section("To repeat it", CommandsHtml(content.commands));
  return html + "</body></html>\n";
}

}  // namespace shoal::launch
