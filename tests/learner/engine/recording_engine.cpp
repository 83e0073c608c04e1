// SPDX-License-Identifier: Apache-2.0
#include "tests/learner/engine/recording_engine.h"

#include <fmt/format.h>

#include <type_traits>

#include "common/nn/host_memory.h"

namespace shoal::learner {
namespace {

// Arrays by their place in memory, numbers by their value.
template <class T>
std::string Word(const nn::ArrayOf<T>& array) {
  return fmt::format("{}:{}", fmt::ptr(nn::HostValues(array).data()), array.size());
}

template <class T>
requires std::is_arithmetic_v<T> std::string Word(T value) { return fmt::format("{}", value); }

template <class T>
std::string Word(T* address) {
  return fmt::format("{}", fmt::ptr(address));
}

std::string Word(std::span<const Array> arrays) {
  std::string words;
  for (const Array array : arrays) words += Word(array) + ",";
  return words;
}

std::string Word(const SquashedSample& sample) {
  return Word(std::array{sample.scaled_noise, sample.action, sample.log_prob});
}

}  // namespace

template <class... Arguments>
void RecordingEngine::Keep(const char* operation, const Arguments&... arguments) {
  std::string line = operation;
  ((line += " ", line += Word(arguments)), ...);  // not " " + Word: g++ 12 warns of an overlap
  operations_.push_back(std::move(line));
}

void RecordingEngine::Begin(const BatchView& drawn) {
  Keep("Begin", drawn.rows());
  engine_->Begin(drawn);
}

Transitions RecordingEngine::Take(const BatchView& batch) {
  Keep("Take", batch.rows());
  return engine_->Take(batch);
}

Array RecordingEngine::TakeRows(std::span<float> values) {
  const Array rows = engine_->TakeRows(values);
  Keep("TakeRows", rows);
  return rows;
}

std::optional<Engine::Outcome> RecordingEngine::End() {
  Keep("End");
  return engine_->End();
}

void RecordingEngine::JoinColumns(Array left, Array right,
                                  std::span<const ObservationSpec::Range> ranges, Array joined) {
  Keep("JoinColumns", left, right, ranges.size(), joined);
  engine_->JoinColumns(left, right, ranges, joined);
}

void RecordingEngine::SplitColumns(Array joined, Array left, Array right) {
  Keep("SplitColumns", joined, left, right);
  engine_->SplitColumns(joined, left, right);
}

void RecordingEngine::GatherLabels(Array observed, Array privileged,
                                   std::span<const LabelColumns> columns, float unit,
                                   Array labels) {
  Keep("GatherLabels", observed, privileged, columns.size(), unit, labels);
  engine_->GatherLabels(observed, privileged, columns, unit, labels);
}

void RecordingEngine::Standardise(Array x, Moments moments, float variance_floor, Array y) {
  Keep("Standardise", x, moments, variance_floor, y);
  engine_->Standardise(x, moments, variance_floor, y);
}

void RecordingEngine::AddToMoments(std::span<const float> vectors, Moments moments) {
  Keep("AddToMoments", vectors.size(), moments);
  engine_->AddToMoments(vectors, moments);
}

void RecordingEngine::SampleSquashedGaussian(Array mean, Array log_std, Random* random,
                                             const SquashedSample& sample) {
  Keep("SampleSquashedGaussian", mean, log_std, sample);
  engine_->SampleSquashedGaussian(mean, log_std, random, sample);
}

void RecordingEngine::SquashedGaussianBackward(const SquashedSample& sample, Array action_gradient,
                                               Number temperature, Array mean_gradient,
                                               Array log_std_gradient) {
  Keep("SquashedGaussianBackward", sample, action_gradient, temperature, mean_gradient,
       log_std_gradient);
  engine_->SquashedGaussianBackward(sample, action_gradient, temperature, mean_gradient,
                                    log_std_gradient);
}

void RecordingEngine::SquashedGaussianFigures(const SquashedSample& sample, Number entropy,
                                              Number saturation) {
  Keep("SquashedGaussianFigures", sample, entropy, saturation);
  engine_->SquashedGaussianFigures(sample, entropy, saturation);
}

void RecordingEngine::AddClippedNoise(Array action, Number sigma, double limit, Random* random,
                                      Array noisy) {
  Keep("AddClippedNoise", action, sigma, limit, noisy);
  engine_->AddClippedNoise(action, sigma, limit, random, noisy);
}

void RecordingEngine::Targets(const TargetTerms& terms, Array y) {
  Keep("Targets", terms.reward, terms.bootstrap, terms.next_q, terms.drawn, terms.next_log_prob,
       terms.temperature, terms.reward_scale, terms.discount, terms.bounds.low, terms.bounds.high,
       y);
  engine_->Targets(terms, y);
}

void RecordingEngine::AverageCopies(int copies, int shifts, Array y) {
  Keep("AverageCopies", copies, shifts, y);
  engine_->AverageCopies(copies, shifts, y);
}

void RecordingEngine::CriticLoss(std::span<const Array> q, Array y, const CriticRows& rows,
                                 std::span<const Array> q_gradients, const CriticNumbers& figures) {
  Keep("CriticLoss", q, y, rows.weights, rows.huber, rows.returns_errors, q_gradients,
       figures.loss);
  engine_->CriticLoss(q, y, rows, q_gradients, figures);
}

void RecordingEngine::EntropyActorLoss(Array log_prob, std::span<const Array> q, ActorValue value,
                                       Number temperature, std::span<const Array> q_gradients,
                                       Number loss) {
  Keep("EntropyActorLoss", log_prob, q, int(value), temperature, q_gradients, loss);
  engine_->EntropyActorLoss(log_prob, q, value, temperature, q_gradients, loss);
}

void RecordingEngine::DeterministicActorLoss(std::span<const Array> q, Array mean, Array action,
                                             double mean_penalty,
                                             std::span<const Array> q_gradients, Number loss,
                                             Number saturation) {
  Keep("DeterministicActorLoss", q, mean, action, mean_penalty, q_gradients, loss, saturation);
  engine_->DeterministicActorLoss(q, mean, action, mean_penalty, q_gradients, loss, saturation);
}

void RecordingEngine::LabelLoss(Array y, Array labels, float weight, float unit, Array gradient,
                                Number mean_square) {
  Keep("LabelLoss", y, labels, weight, unit, gradient, mean_square);
  engine_->LabelLoss(y, labels, weight, unit, gradient, mean_square);
}

void RecordingEngine::ClippedPolicyLoss(const ClippedPolicyTerms& terms, nn::ParameterSet* log_std,
                                        Array mean_gradient, Array value_gradient,
                                        const ClippedPolicyNumbers& figures) {
  Keep("ClippedPolicyLoss", terms.mean, terms.value, terms.drawn_action, terms.old_log_prob,
       terms.old_value, terms.advantage, terms.target, terms.clip, terms.value_clip,
       terms.value_weight, terms.entropy_weight, int(terms.normalise_advantages), log_std,
       mean_gradient, value_gradient, figures.total);
  engine_->ClippedPolicyLoss(terms, log_std, mean_gradient, value_gradient, figures);
}

void RecordingEngine::GaussianFigures(const nn::ParameterSet& log_std, Number deviation,
                                      Number entropy) {
  Keep("GaussianFigures", &log_std, deviation, entropy);
  engine_->GaussianFigures(log_std, deviation, entropy);
}

void RecordingEngine::Mean(Array values, Number mean) {
  Keep("Mean", values, mean);
  engine_->Mean(values, mean);
}

void RecordingEngine::OnHost(std::span<const Array> inputs, std::span<const Array> outputs,
                             const HostOperation& operation) {
  Keep("OnHost", inputs, outputs);
  engine_->OnHost(inputs, outputs, operation);
}

void RecordingEngine::Temperature(const nn::ParameterSet& log_temperature, Number temperature) {
  Keep("Temperature", &log_temperature, temperature);
  engine_->Temperature(log_temperature, temperature);
}

void RecordingEngine::TemperatureLoss(Number temperature, Number entropy, float target_entropy,
                                      Number loss) {
  Keep("TemperatureLoss", temperature, entropy, target_entropy, loss);
  engine_->TemperatureLoss(temperature, entropy, target_entropy, loss);
}

void RecordingEngine::StepTemperature(Number loss, double least, nn::ParameterSet* log_temperature,
                                      nn::Adam* optimiser) {
  Keep("StepTemperature", loss, least, log_temperature, optimiser);
  engine_->StepTemperature(loss, least, log_temperature, optimiser);
}

void RecordingEngine::RequireFinite(Number number) {
  Keep("RequireFinite", number);
  engine_->RequireFinite(number);
}

void RecordingEngine::SetRateFactor(Number factor, nn::Adam* optimiser) {
  Keep("SetRateFactor", factor, optimiser);
  engine_->SetRateFactor(factor, optimiser);
}

void RecordingEngine::Gather(nn::Adam* optimiser, Number gradient_squares) {
  Keep("Gather", optimiser, gradient_squares);
  engine_->Gather(optimiser, gradient_squares);
}

void RecordingEngine::HoldSteps(Number number, double limit) {
  Keep("HoldSteps", number, limit);
  engine_->HoldSteps(number, limit);
}

void RecordingEngine::Step(nn::Adam* optimiser, std::span<nn::Module* const> changed,
                           NextUse next_use) {
  Keep("Step", optimiser, changed.size(), int(next_use));
  engine_->Step(optimiser, changed, next_use);
}

void RecordingEngine::MoveTowards(float tau, std::span<const nn::Following> targets) {
  Keep("MoveTowards", tau, targets.size());
  engine_->MoveTowards(tau, targets);
}

void RecordingEngine::MoveAverage(float rate, const nn::ParameterSet& online,
                                  nn::ParameterSet* average) {
  Keep("MoveAverage", rate, &online, average);
  engine_->MoveAverage(rate, online, average);
}

}  // namespace shoal::learner
