// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/scale_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/error.h"

namespace shoal::bench {
namespace {

// Workload of the rows: batches of 128 with one camera's frames of (3, 84, 84).
constexpr double kFrameBytes = 3 * 84 * 84;
constexpr double kRecordBytes = kFrameBytes + 120;  // header and action
constexpr double kBatchBytes = 2 * kScaleBatch * kFrameBytes;
constexpr double kLinkBytes = 10e9 / 8;  // a second, of 10 Gb/s
constexpr double kSamplesPerInsert[] = {8, 64};
constexpr int kActors[] = {16, 100, 1000};

constexpr const char* kIntakeRow = "replay server under 16 actor processes";
constexpr const char* kGatherRow =
    "128 samples of (3, 84, 84), drawn and shifted, of 200000 records";
constexpr const char* kHandoverRow =
    "batches handed to a learner on the same host, beside the gather";
constexpr const char* kUpdateRow = "SAC update, compact, batch 128 of (6, 84, 84), auto";
constexpr const char* kActorRow = "1 actor of FetchReach with one 84x84 camera, fast";

const ReportedRow& RowOf(std::span<const Report> reports, std::string_view stage) {
  for (const Report& report : reports) {
    const auto found = std::ranges::find(report.rows, stage, &ReportedRow::stage);
    if (found != report.rows.end()) return *found;
  }
  throw RuntimeError("none of the files has a row '{}'", stage);
}

// The most exceeded resource and the number of it that would suffice; "nothing".
std::string NextLimit(const ScaleLoad& load) {
  const std::pair<double, const char*> shares[] = {{load.replay, "replay servers"},
                                                   {load.learner, "learner cores"},
                                                   {load.link_in, "links to the replay"},
                                                   {load.link_out, "links to the learner"}};
  const auto most = std::ranges::max(shares);
  if (most.first <= 1) return "nothing";
  return fmt::format("{:.0f} {}", std::ceil(most.first), most.second);
}

}  // namespace

ScaleConstants ReadScaleConstants(std::span<const Report> reports) {
  const ReportedRow& handover = RowOf(reports, kHandoverRow);
  if (!handover.against_figure) throw RuntimeError("'{}' has nothing against it", kHandoverRow);
  return {.actor_rate = RowOf(reports, kActorRow).figure,
          .intake = 1 / RowOf(reports, kIntakeRow).figure,
          .gather = 1 / RowOf(reports, kGatherRow).figure,
          .handover_near = handover.figure / 1e9,
          .handover_far = *handover.against_figure / 1e9,
          .update = 1 / RowOf(reports, kUpdateRow).figure};
}

ScaleLoad LoadOf(const ScaleConstants& constants, double transitions_per_second,
                 double samples_per_insert, bool far) {
  const double batches = transitions_per_second * samples_per_insert / kScaleBatch;
  const double handover = far ? constants.handover_far : constants.handover_near;
  return {.replay = transitions_per_second * constants.intake +
                    batches * (constants.gather + kBatchBytes * handover),
          .learner = batches * constants.update,
          .link_in = transitions_per_second * kRecordBytes / kLinkBytes,
          .link_out = far ? batches * kBatchBytes / kLinkBytes : 0};
}

std::string ScaleTables(const ScaleConstants& constants) {
  std::string text = "| measured | figure | row |\n| --- | --- | --- |\n";
  const auto constant = [&](const char* what, double value, const char* unit, const char* row) {
    text += fmt::format("| {} | {:.4g} {} | {} |\n", what, value, unit, row);
  };
  constant("one actor on a core", constants.actor_rate, "env steps/s", kActorRow);
  constant("the replay takes a transition", 1e6 * constants.intake, "us of CPU", kIntakeRow);
  constant("the replay gathers a batch", 1e3 * constants.gather, "ms of CPU", kGatherRow);
  constant("it hands a batch to a learner on its host", 1e3 * kBatchBytes * constants.handover_near,
           "ms of CPU", kHandoverRow);
  constant("to one on another host", 1e3 * kBatchBytes * constants.handover_far, "ms of CPU",
           kHandoverRow);
  constant("one update on one thread", 1e3 * constants.update, "ms of CPU", kUpdateRow);

  text += "\n| carried by one, in env steps/s |";
  for (const double samples : kSamplesPerInsert) {
    text += fmt::format(" {:.0f} samples per insert |", samples);
  }
  text += "\n| --- | --- | --- |\n";
  const auto carried = [&](const char* what, bool far, double ScaleLoad::*share) {
    text += fmt::format("| {} |", what);
    for (const double samples : kSamplesPerInsert) {
      text += fmt::format(" {:.0f} |", 1 / (LoadOf(constants, 1, samples, far).*share));
    }
    text += "\n";
  };
  carried("replay, learner on its host", false, &ScaleLoad::replay);
  carried("replay, learner on another", true, &ScaleLoad::replay);
  carried("core of a learner", false, &ScaleLoad::learner);
  carried("10 Gb/s of records", false, &ScaleLoad::link_in);
  carried("10 Gb/s of batches", true, &ScaleLoad::link_out);

  text +=
      "\n| actors | samples per insert | env steps/s | replay | learner core | link in | link out "
      "| what the most exceeded needs |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const int actors : kActors) {
    for (const double samples : kSamplesPerInsert) {
      const double rate = actors * constants.actor_rate;
      const ScaleLoad load = LoadOf(constants, rate, samples, /*far=*/true);
      text += fmt::format("| {} | {:.0f} | {:.0f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {} |\n",
                          actors, samples, rate, load.replay, load.learner, load.link_in,
                          load.link_out, NextLimit(load));
    }
  }
  return text;
}

}  // namespace shoal::bench
