// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/report.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stop.h"
#include "launch/commands/json_output.h"
#include "launch/commands/target_options.h"
#include "launch/record/run_folder.h"
#include "launch/tools/commands/commands.h"
#include "launch/tools/report/card.h"
#include "launch/tools/report/compare.h"
#include "launch/tools/report/plot.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr char kDefaultPlot[] = "curves.png";

struct CompareOptions {
  SubjectOptions subjects;
  double target = 0.9;
  std::string json;
};

struct PlotOptions {
  SubjectOptions subjects;
  std::string axis = "env-steps";
  std::vector<std::string> figures;  // empty = all figures of the runs
  std::vector<std::string> outputs;
  std::string title;
  std::vector<std::string> references;
};

void AddSubjects(CLI::App* command, SubjectOptions* subjects) {
  command->add_option("subjects", subjects->names, "Runs and experiments: names or folders")
      ->required();
  command->add_option("--run-dir", subjects->run_dir, "Folder that holds the runs")
      ->capture_default_str();
}

void AddReferences(CLI::App* command, std::vector<std::string>* references) {
  command
      ->add_option("--reference", *references,
                   "Published results to draw: a file (*.json), or the name of one that Shoal "
                   "provides; may be repeated")
      ->allow_extra_args(false);
}

std::vector<Reference> ReadReferences(const std::vector<std::string>& words) {
  std::vector<Reference> references;
  for (const std::string& word : words) {
    if (std::ranges::count(words, word) > 1) {
      throw UsageError("--reference: '{}' is given twice", word);
    }
    references.push_back(ReadReference(FindReference(word)));
  }
  return references;
}

int CompareSubjects(const CompareOptions& options) {
  const JsonOutput output(options.json, JsonOutput::Readers::kOthers);
  const Comparison comparison =
      launch::Compare(ReadSubjects(options.subjects).groups, options.target);
  output.Write(ToJson(comparison).dump(2) + "\n");
  std::fputs(ToText(comparison).c_str(), output.text());
  return 0;
}

// Title of the picture: the subjects by name, and their tasks.
std::string TitleOf(const PlotOptions& options, const Subjects& subjects) {
  if (!options.title.empty()) return options.title;
  std::string title;
  for (const Subject& subject : subjects.named) {
    title += (title.empty() ? "" : ", ") + subject.name;
  }
  return fmt::format("{}: {}", title, fmt::join(TasksOf(subjects.groups), ", "));
}

int DrawPlot(const PlotOptions& options) {
  InstallStopSignals();
  const std::vector<Reference> references = ReadReferences(options.references);
  Subjects subjects = ReadSubjects(options.subjects);
  if (subjects.named.size() > 1) CheckOneTask(subjects.groups);
  ReadRollouts(&subjects.groups);
  Plot plot{.title = TitleOf(options, subjects),
            .axis = ParsePlotAxis(options.axis),
            .figures = {},
            .references = references};
  for (const std::string& word : options.figures) plot.figures.push_back(ParsePlotFigure(word));
  if (plot.figures.empty()) plot.figures = FiguresThereAre(subjects.groups);
  const std::vector<std::string> outputs =
      options.outputs.empty() ? std::vector<std::string>{kDefaultPlot} : options.outputs;
  for (const std::string& output : outputs) {
    Draw(plot, subjects.groups, output);
    std::cout << output << "\n";
  }
  return 0;
}

struct ReportOptions {
  SubjectOptions subjects;
  std::string output = "report.html";
  std::vector<std::string> references;
};

int WriteReport(const ReportOptions& options) {
  InstallStopSignals();
  CheckWritable(options.output);
  WriteFileForOthers(options.output, ReportHtml(GatherReport(options.subjects,
                                                             ReadReferences(options.references))));
  std::cout << options.output << "\n";
  return 0;
}

struct CardOptions {
  std::string run, run_dir = "runs", output;
};

int MakeCard(const CardOptions& options) {
  const fs::path run = FindNamed(options.run, RunsIn(options.run_dir));
  const fs::path output = options.output.empty()
                              ? fs::path(NamedFolder(run).filename().string() + "-card")
                              : fs::path(options.output);
  WriteCard(run, output);
  std::cout << output.string() << "\n";
  return 0;
}

}  // namespace

void AddCardCommand(CLI::App& app, Action* chosen) {
  CLI::App* command = app.add_subcommand(
      "card",
      "Write a run as a folder for model hubs: README with metadata, results, config, policy.");
  const auto options = std::make_shared<CardOptions>();
  AddRunOption(*command, &options->run, &options->run_dir)->required();
  command->add_option("--output", options->output, "Folder to create; RUN-card by default");
  command->callback([=] { *chosen = [=] { return MakeCard(*options); }; });
}

void AddReportCommand(CLI::App& app, Action* chosen) {
  CLI::App* command =
      app.add_subcommand("report",
                         "Write one self-contained HTML page of runs and experiments: results with "
                         "intervals, curves, configuration, machine, commands. Needs gnuplot.");
  const auto options = std::make_shared<ReportOptions>();
  AddSubjects(command, &options->subjects);
  command->add_option("--output", options->output, "File to write")->capture_default_str();
  AddReferences(command, &options->references);
  command->callback([=] { *chosen = [=] { return WriteReport(*options); }; });
}

void AddCompareCommand(CLI::App& app, Action* chosen) {
  CLI::App* command = app.add_subcommand(
      "compare",
      "Compare runs and experiments side by side: success, return, cost, with intervals over "
      "seeds; ratios of env steps; the keys in which they differ.");
  const auto options = std::make_shared<CompareOptions>();
  AddSubjects(command, &options->subjects);
  command->add_option("--target", options->target, "Success rate whose env steps are compared")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--json", options->json,
                      "Write the result as JSON to this file, which is replaced; - for standard "
                      "output (schema shoal-comparison-1)");
  command->callback([=] { *chosen = [=] { return CompareSubjects(*options); }; });
}

void AddPlotCommand(CLI::App& app, Action* chosen) {
  CLI::App* command = app.add_subcommand(
      "plot",
      "Draw learning curves, with bands from the smallest to the largest seed. Needs gnuplot.");
  const auto options = std::make_shared<PlotOptions>();
  AddSubjects(command, &options->subjects);
  command->add_option("--x", options->axis, "env-steps | frames | updates | wall")
      ->capture_default_str();
  command
      ->add_option("--y", options->figures,
                   "success | return | distance; may be repeated; default: all that the runs have")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--output", options->outputs,
          fmt::format("File to write, .png or .svg; may be repeated; {} by default", kDefaultPlot))
      ->allow_extra_args(false);
  command->add_option("--title", options->title, "Title above the curves");
  AddReferences(command, &options->references);
  command->callback([=] { *chosen = [=] { return DrawPlot(*options); }; });
}

}  // namespace shoal::launch
