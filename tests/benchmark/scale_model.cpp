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
constexpr const char* kHandoverFarRow =
    "batches handed to a learner on the same host, beside the gather, compared with: over the "
    "network";
constexpr const char* kUpdateRow = "SAC update, compact, batch 128 of (6, 84, 84), auto";
constexpr const char* kActorRow = "1 actor of FetchReach with one 84x84 camera, fast";

const ReportedRow& RowOf(std::span<const Report> reports, std::string_view stage) {
  for (const Report& report : reports) {
    const auto found = std::ranges::find(report.rows, stage, &ReportedRow::stage);
    if (found != report.rows.end()) return *found;
  }
  throw RuntimeError("none of the files has a row '{}'", stage);
}

// The most overloaded resource and the number of it that would suffice; "nothing".
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
  std::string text =
      "| measured quantity | value | row of the measurement |\n| --- | --- | --- |\n";
  const auto constant = [&](const char* what, double value, const char* unit, const char* row) {
    text += fmt::format("| {} | {:.4g} {} | {} |\n", what, value, unit, row);
  };
  constant("env steps of one actor on one core", constants.actor_rate, "env steps/s", kActorRow);
  constant("the replay server receives one transition", 1e6 * constants.intake, "us of CPU",
           kIntakeRow);
  constant("the replay server gathers one batch", 1e3 * constants.gather, "ms of CPU", kGatherRow);
  constant("one batch is handed to a learner on the same host",
           1e3 * kBatchBytes * constants.handover_near, "ms of CPU", kHandoverRow);
  constant("one batch is handed to a learner on another host",
           1e3 * kBatchBytes * constants.handover_far, "ms of CPU", kHandoverFarRow);
  constant("the learner computes one update on one thread", 1e3 * constants.update, "ms of CPU",
           kUpdateRow);

  text += "\n| env steps/s that one resource carries |";
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
  carried("replay server, learner on the same host", false, &ScaleLoad::replay);
  carried("replay server, learner on another host", true, &ScaleLoad::replay);
  carried("core of the learner", false, &ScaleLoad::learner);
  carried("10 Gb/s link, records", false, &ScaleLoad::link_in);
  carried("10 Gb/s link, batches to a learner on another host", true, &ScaleLoad::link_out);

  text += R"(
The next table has the loads of the replay server, the learner and the link: 1 means that one
replay server, one core of the learner or one direction of one link is fully used. The learner
is on another host.

| actors | samples per insert | env steps/s | replay server | learner | link in | link out |)";
  text += " needed of the most overloaded resource |\n";
  text += "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
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
