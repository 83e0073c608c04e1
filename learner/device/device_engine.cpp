// SPDX-License-Identifier: Apache-2.0
#include "learner/device/device_engine.h"

#include <algorithm>
#include <cstddef>

#include "common/base/check.h"
#include "common/nn/device_memory.h"
#include "learner/engine/batch_faults.h"
#include "learner/engine/moments.h"

namespace shoal::learner::device {
namespace {

using nn::AddressOf;
using nn::DeviceArray;

// Makes arrays of a batch in a landing. If the memory of the batch is one block, the block is
// copied as a whole.
class BatchPlaces {
 public:
  BatchPlaces(const BatchView& batch, Landing* landing) : landing_(landing) {
    if (batch.data == nullptr || batch.first_row != 0) return;
    if (batch.rows() != size_t(batch.schema->batch())) return;
    block_ = {batch.data, batch.schema->total_bytes()};
    place_ = landing->Borrow(block_);
  }

  template <class T>
  nn::ArrayOf<T> Of(std::span<T> values) {
    if (values.empty()) return {};
    return DeviceArray(AddressOfValues(std::span<const T>(values)), int64_t(values.size()));
  }

 private:
  template <class T>
  T* AddressOfValues(std::span<const T> values) {
    const auto* first = reinterpret_cast<const uint8_t*>(values.data());
    if (block_.data() <= first && first < block_.data() + block_.size()) {
      return reinterpret_cast<T*>(place_ + (first - block_.data()));
    }
    return landing_->Add(values);
  }

  Landing* const landing_;
  std::span<const uint8_t> block_;
  uint8_t* place_ = nullptr;
};

}  // namespace

DeviceEngine::DeviceEngine(Device* device, nn::Precision precision, int batch, int in_flight)
    : device_(device),
      in_flight_(size_t(in_flight)),
      workspace_(device, precision, batch),
      networks_(&workspace_),
      modules_(precision, batch, /*threads=*/1),
      recordings_(device),
      results_(workspace_.New<Results>(1)),
      read_{},
      counter_(workspace_.New<int32_t>(1)) {
  CHECK(in_flight >= 0) << in_flight;
  modules_.maker = &networks_;
  for (int i = 0; i < 2; ++i) landings_.push_back(std::make_unique<Landing>(device));
  for (int i = 0; i <= in_flight; ++i) {
    slots_.push_back(
        {static_cast<Results*>(device->AllocateHost(sizeof(Results))),
         static_cast<float*>(device->AllocateHost(int64_t{batch} * int64_t(sizeof(float)))),
         /*has_errors=*/false, device->NewEvent()});
  }
}

DeviceEngine::~DeviceEngine() {
  Quietly([&] { device_->Finish(); });  // recordings are not destroyed while they run
  for (const Slot& slot : slots_) {
    Quietly([&] { device_->FreeHost(slot.results); });
    Quietly([&] { device_->FreeHost(slot.errors); });
  }
}

// ---- Memory and numbers ----

Array DeviceEngine::NewArray(int columns) {
  const int64_t size = int64_t{rows()} * columns;
  return DeviceArray(workspace_.New<float>(size), size);
}

Number DeviceEngine::NewNumber() {
  CHECK(numbers_ < Results::kMostNumbers) << numbers_ << " numbers";
  return DeviceArray(&results_->numbers[numbers_++], 1);
}

Moments DeviceEngine::NewMoments(int width) {
  const auto size = int64_t(MomentsSize(size_t(width)));
  return DeviceArray(workspace_.New<double>(size), size);
}

size_t DeviceEngine::IndexOf(Number number) const {
  const ptrdiff_t index = AddressOf(number) - &results_->numbers[0];
  CHECK(index >= 0 && size_t(index) < numbers_);
  return size_t(index);
}

void DeviceEngine::Set(Number number, double value) {
  CHECK(!updating_);
  host_numbers_[IndexOf(number)] = value;
  read_.numbers[IndexOf(number)] = value;
}

void DeviceEngine::Put(std::span<const float> values, Array array) {
  CHECK(!updating_ && int64_t(values.size()) == array.size()) << values.size();
  device_->CopyIn(Lane::kCommands, values.data(), int64_t(values.size_bytes()), AddressOf(array));
  device_->Finish();
}

double DeviceEngine::Read(Number number) const {
  CHECK(!updating_) << "an update depends on no number that is read";
  return read_.numbers[IndexOf(number)];
}

std::vector<float> DeviceEngine::ReadRows(Array array) const {
  CHECK(!updating_) << "an update depends on no array that is read";
  std::vector<float> values(size_t(array.size()));
  device_->CopyOut(Lane::kCommands, AddressOf(array), int64_t(values.size() * sizeof(float)),
                   values.data());
  device_->Finish();
  return values;
}

std::function<std::vector<double>()> DeviceEngine::CopyMoments(Moments moments) const {
  CHECK(!updating_);
  const auto size = size_t(moments.size());
  return [size, copy = workspace_.host_copies().Begin(AddressOf(moments),
                                                      int64_t(size * sizeof(double)))] {
    const auto* values = static_cast<const double*>(copy->Wait());
    return std::vector<double>(values, values + size);
  };
}

void DeviceEngine::SetMoments(Moments moments, std::span<const double> values) {
  CHECK(!updating_ && int64_t(values.size()) == moments.size()) << values.size();
  device_->CopyIn(Lane::kCommands, values.data(), int64_t(values.size_bytes()), AddressOf(moments));
  device_->Finish();
}

// ---- An update ----

void DeviceEngine::BeginInputs() {
  turn_ = (turn_ + 1) % landings_.size();
  landing().Begin();
}

void DeviceEngine::Begin(const BatchView& drawn) {
  CHECK(!updating_ && int(drawn.rows()) == rows()) << "batch of " << drawn.rows();
  BeginInputs();
  const int32_t finite[] = {AllFinite(drawn) ? 1 : 0};
  batch_finite_ = landing().Add(std::span<const int32_t>(finite));
  workspace_.BeginList(kernels::BeginUpdate{});
  updating_ = true;
  stepped_.clear();
  returns_errors_ = false;
  SetHostNumbers();
}

// The host's numbers travel with the inputs, because updates in flight still read the numbers from
// before.
void DeviceEngine::SetHostNumbers() {
  for (const auto& [index, value] : host_numbers_) {
    const double number[] = {value};
    const double* from = landing().Add(std::span<const double>(number));
    workspace_.Add(
        Copy{.from = from, .to = &results_->numbers[index], .bytes = int64_t(sizeof(double))});
  }
}

Transitions DeviceEngine::Take(const BatchView& batch) {
  CHECK(batch.steps.empty()) << "sequences are computed on the CPU";
  BatchPlaces places(batch, &landing());
  return {.obs_frames = places.Of(batch.obs_frames),
          .next_obs_frames = places.Of(batch.next_obs_frames),
          .obs_vector = places.Of(batch.obs_vector),
          .next_obs_vector = places.Of(batch.next_obs_vector),
          .obs_privileged = places.Of(batch.obs_privileged),
          .next_obs_privileged = places.Of(batch.next_obs_privileged),
          .action = places.Of(batch.action),
          .reward = places.Of(batch.reward),
          .bootstrap = places.Of(batch.bootstrap),
          .drawn_action = places.Of(batch.drawn_action),
          .log_prob = places.Of(batch.log_prob)};
}

Array DeviceEngine::TakeRows(std::span<float> values) {
  CHECK(updating_ && int(values.size()) == rows()) << values.size();
  return DeviceArray(landing().Add(std::span<const float>(values)), int64_t(values.size()));
}

kernels::BeginUpdate DeviceEngine::FirstCommand() const {
  kernels::BeginUpdate begin{.batch_finite = batch_finite_, .flags = &results_->flags};
  CHECK(stepped_.size() <= size_t(kernels::BeginUpdate::kMostOptimisers)) << stepped_.size();
  for (const nn::Adam* optimiser : stepped_) {
    begin.optimisers[begin.optimiser_count++] = DeviceAdam::Of(*optimiser).state();
  }
  return begin;
}

void DeviceEngine::AddEndUpdate() {
  kernels::EndUpdate end;
  end.flags = &results_->flags;
  end.finished = counter_;
  for (const nn::Adam* optimiser : stepped_) {
    for (size_t i = 0; i < optimiser->sets().size(); ++i) {
      CHECK(end.set_count < kernels::EndUpdate::kMostUndone) << end.set_count << " sets";
      end.sets[end.set_count] = AdamSetOf(*optimiser, i);
      end.states[end.set_count] = DeviceAdam::Of(*optimiser).state();
      end.counts[end.set_count++] = i == 0;
    }
  }
  workspace_.Add(end);
}

// Runs the update, and copies its results to a free slot.
void DeviceEngine::Submit() {
  AddEndUpdate();
  const CommandList& commands = workspace_.EndList(FirstCommand());
  landing().Send();
  recordings_.Run(commands);
  landing().MarkUsed();
  size_t slot = 0;
  while (std::ranges::count(flying_, slot) > 0) ++slot;
  flying_.push_back(slot);
  const auto bytes = int64_t(offsetof(Results, numbers) + numbers_ * sizeof(double));
  device_->CopyOut(Lane::kCommands, results_, bytes, slots_[slot].results);
  slots_[slot].has_errors = returns_errors_;
  if (returns_errors_) {
    device_->CopyOut(Lane::kCommands, errors_, int64_t{rows()} * int64_t(sizeof(float)),
                     slots_[slot].errors);
  }
  device_->Mark(Lane::kCommands, slots_[slot].arrived.get());
}

std::optional<Engine::Outcome> DeviceEngine::End() {
  CHECK(updating_);
  updating_ = false;
  Submit();
  landing().Arrive();  // the batch may change from now on
  if (flying_.size() <= in_flight_) return std::nullopt;
  return TakeOutcome();
}

Engine::Outcome DeviceEngine::WaitOutcome() {
  CHECK(!updating_ && !flying_.empty()) << "no update is in flight";
  return TakeOutcome();
}

Engine::Outcome DeviceEngine::TakeOutcome() {
  const Slot& slot = slots_[flying_.front()];
  flying_.pop_front();
  device_->Wait(*slot.arrived);
  read_ = *slot.results;
  read_errors_.assign(slot.errors, slot.errors + (slot.has_errors ? rows() : 0));
  const kernels::Flags flags = read_.flags;
  if (flags.finite == 0) {
    // The updates behind this one had no effect. They end before the halt does.
    device_->Finish();
    flying_.clear();
    const int32_t halted = 0;
    device_->CopyIn(Lane::kCommands, &halted, sizeof(halted), &results_->flags.halted);
    device_->Finish();
  }
  return {.finite = flags.finite != 0,
          .batch_finite = flags.batch_finite != 0,
          .held = flags.held != 0};
}

// ---- The flag, steps and moves ----

void DeviceEngine::RequireFinite(Number number) {
  kernels::RequireFinite require{.count = 1};
  require.numbers[0] = AddressOf(number);
  require.flags = &results_->flags;
  workspace_.Add(require);
}

void DeviceEngine::SetRateFactor(Number factor, nn::Adam* optimiser) {
  for (const nn::ParameterSet* set : optimiser->sets()) Use(*set, /*changes=*/false, nullptr);
  Use(optimiser).rate_factor = AddressOf(factor);
}

void DeviceEngine::Gather(nn::Adam* optimiser, Number gradient_squares) {
  DeviceAdam& adam = Use(optimiser);
  adam.squares = AddressOf(gradient_squares);
  kernels::SumOfSquares sum;
  for (const nn::ParameterSet* set : optimiser->sets()) {
    const DeviceParameters& parameters = DeviceParameters::Of(*set);
    CHECK(sum.set_count < kernels::kMostSets);
    sum.sets[sum.set_count++] = {parameters.gradients(), parameters.layout().trained_size()};
  }
  sum.partials = adam.partials;
  sum.finished = counter_;
  sum.squares = AddressOf(gradient_squares);
  workspace_.Add(sum);
}

void DeviceEngine::HoldSteps(Number number, double limit) {
  workspace_.Add(
      kernels::HoldSteps{.number = AddressOf(number), .limit = limit, .flags = &results_->flags});
}

void DeviceEngine::Step(nn::Adam* optimiser, std::span<nn::Module* const>, NextUse) {
  DeviceAdam& adam = Use(optimiser);
  stepped_.push_back(optimiser);
  kernels::Adam step;
  for (size_t i = 0; i < optimiser->sets().size(); ++i) {
    const DeviceParameters& parameters = Use(*optimiser->sets()[i], /*changes=*/true, nullptr);
    CHECK(step.set_count < kernels::kMostSets);
    step.gradients[step.set_count] = parameters.gradients();
    step.sets[step.set_count++] = AdamSetOf(*optimiser, i);
  }
  step.options = OptionsOf(*optimiser);
  step.squares = adam.squares;
  step.state = adam.state();
  step.flags = &results_->flags;
  step.finished = counter_;
  workspace_.Add(step);
}

void DeviceEngine::MoveTowards(float tau, std::span<const nn::Following> targets) {
  kernels::MoveTowards move;
  for (const nn::Following& following : targets) {
    const DeviceParameters& online =
        Use(following.online->parameters(), /*changes=*/false, nullptr);
    const DeviceParameters& target = Use(following.target->parameters(), /*changes=*/true, nullptr);
    CHECK(move.set_count < kernels::kMostSets);
    move.sets[move.set_count++] = {online.layout().size(), online.layout().trained_size(),
                                   online.values(), target.values(), target.rounded()};
  }
  move.tau = tau;
  move.flags = &results_->flags;
  workspace_.Add(move);
}

void DeviceEngine::MoveAverage(float rate, const nn::ParameterSet& online,
                               nn::ParameterSet* average) {
  const DeviceParameters& from = Use(online, /*changes=*/false, nullptr);
  const DeviceParameters& to = Use(*average, /*changes=*/true, &from.layout());
  kernels::MoveTowards move;
  move.set_count = 1;
  move.sets[0] = {from.layout().size(), from.layout().trained_size(), from.values(), to.values(),
                  nullptr};
  move.tau = rate;
  move.flags = &results_->flags;
  workspace_.Add(move);
}

// ---- Mirrors ----

// `layout`: of a set without a mirror; null: the host's order. The mirror has gradients if the set
// has.
DeviceParameters& DeviceEngine::Use(const nn::ParameterSet& set, bool changes,
                                    const ParameterLayout* layout) {
  if (set.mirror() == nullptr) {
    DeviceParameters::Attach(&workspace_, layout != nullptr ? *layout : ParameterLayout(set),
                             set.gradients() != nullptr ? nn::ParameterSet::Use::kTraining
                                                        : nn::ParameterSet::Use::kInference,
                             set);
  }
  set.UseMirror(changes);
  return DeviceParameters::Of(set);
}

DeviceAdam& DeviceEngine::Use(nn::Adam* optimiser) {
  if (optimiser->mirror() == nullptr) {
    optimiser->Attach(std::make_unique<DeviceAdam>(&workspace_, *optimiser));
  }
  optimiser->UseMirror();
  return DeviceAdam::Of(*optimiser);
}

kernels::AdamSet DeviceEngine::AdamSetOf(const nn::Adam& optimiser, size_t i) const {
  const DeviceParameters& parameters = DeviceParameters::Of(*optimiser.sets()[i]);
  const DeviceAdam::Arrays& arrays = DeviceAdam::Of(optimiser).arrays()[i];
  return {.size = parameters.layout().size(),
          .trained = parameters.layout().trained_size(),
          .value = parameters.values(),
          .m = arrays.m,
          .v = arrays.v,
          .former_value = arrays.former_value,
          .former_m = arrays.former_m,
          .former_v = arrays.former_v,
          .rounded = parameters.rounded(),
          .next_statistics = parameters.next_statistics()};
}

kernels::AdamOptions DeviceEngine::OptionsOf(const nn::Adam& optimiser) const {
  const nn::Adam::Options& options = optimiser.options();
  return {.rate = options.rate,
          .epsilon = options.epsilon,
          .max_norm = options.max_norm,
          .rate_factor = DeviceAdam::Of(optimiser).rate_factor};
}

}  // namespace shoal::learner::device
