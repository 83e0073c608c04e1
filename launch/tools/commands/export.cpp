// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/policy/checkpoint_policy.h"
#include "launch/commands/target_options.h"
#include "launch/tools/commands/commands.h"
#include "launch/tools/export/onnx_export.h"
#include "launch/tools/export/samples.h"
#include "launch/tools/export/sb3_policy.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  CheckpointWords checkpoint;
  std::string onnx, sb3, samples;
  uint64_t seed = 1;
};

// The plain evaluator is slow on pictures: an eighth of a second to two seconds each.
constexpr int kPictures = 8, kVectors = 100;

// Observations on which the exported policy is compared.
struct Sets {
  std::vector<ObservationSet> sets;
  std::vector<std::string> names;
  std::string why_none_recorded;
};

Sets DrawSets(const policy::CheckpointPolicy& policy, const fs::path& checkpoint, uint64_t seed) {
  const ObservationSpec& spec = policy.description.spec;
  const int count = spec.HasPixels() ? kPictures : kVectors;
  const auto scale = nn::ReadVectorScale(policy.tensors, spec.VectorSize(), kPolicyFile);
  Sets sets{.sets = {RandomObservations(spec, scale, count, seed)},
            .names = {"random"},
            .why_none_recorded = {}};
  if (auto recorded =
          RecordedObservations(checkpoint, spec, count, seed, &sets.why_none_recorded)) {
    sets.sets.push_back(*std::move(recorded));
    sets.names.emplace_back("recorded");
  }
  return sets;
}

void PrintAgreements(const OnnxExport& exported, const Sets& sets) {
  for (size_t i = 0; i < exported.agreements.size(); ++i) {
    const auto& [observations, difference, least, most] = exported.agreements[i];
    fmt::print("  {} {} observations: largest difference {:.1e}, actions from {:.3f} to {:.3f}\n",
               observations, sets.names[i], difference, least, most);
  }
  if (!sets.why_none_recorded.empty()) {
    fmt::print("  no recorded observations: {}\n", sets.why_none_recorded);
  }
}

int Export(const ExportOptions& options) {
  if (options.onnx.empty() && options.sb3.empty()) {
    throw UsageError("nothing to export to: expected --onnx FILE or --sb3 FILE");
  }
  for (const std::string& file : {options.onnx, options.sb3, options.samples}) {
    if (!file.empty()) CheckWritable(file);
  }
  const fs::path checkpoint = FindCheckpoint(options.checkpoint).checkpoint;
  const policy::CheckpointPolicy policy = policy::ReadCheckpointPolicy(checkpoint);
  const Sets sets = DrawSets(policy, checkpoint, options.seed);
  // Make all exports before any file is written.
  std::optional<OnnxExport> onnx;
  std::optional<Sb3File> sb3;
  if (!options.onnx.empty()) onnx = ExportOnnx(policy, sets.sets);
  if (!options.sb3.empty()) sb3 = WriteSb3(policy);
  if (!options.samples.empty()) {
    WriteFileForOthers(options.samples, WriteSamples(policy, sets.sets));
  }
  if (onnx) {
    WriteFileForOthers(options.onnx, onnx->bytes);
    fmt::print("{}: {} ({:.2f} MB)\n", options.onnx, policy.description.spec.Summary(),
               1e-6 * static_cast<double>(onnx->bytes.size()));
    PrintAgreements(*onnx, sets);
  }
  if (sb3) {
    WriteFileForOthers(options.sb3, sb3->bytes);
    fmt::print("{}: for model.set_parameters(\"{}\", exact_match=False) of\n  model = {}\n",
               options.sb3, options.sb3, sb3->model);
    for (const std::string& note : sb3->notes) fmt::print("  {}\n", note);
  }
  return 0;
}

}  // namespace

void AddExportCommand(CLI::App& app, Action* chosen) {
  CLI::App* command =
      app.add_subcommand("export",
                         "Export a checkpoint's policy for other programs: an ONNX file from raw "
                         "observations to actions, compared with the policy before it is written, "
                         "or parameters for Stable-Baselines3.");
  const auto options = std::make_shared<ExportOptions>();
  AddCheckpointOptions(*command, &options->checkpoint);
  command->add_option("--onnx", options->onnx, "ONNX file to write");
  command->add_option("--sb3", options->sb3,
                      "Zip file to write, for set_parameters of Stable-Baselines3");
  command->add_option(
      "--samples", options->samples,
      "safetensors file for observations and the policy's actions, to compare other programs with");
  command->add_option("--seed", options->seed, "Seed of the observations")->capture_default_str();
  command->callback([=] { *chosen = [=] { return Export(*options); }; });
}

}  // namespace shoal::launch
