// SPDX-License-Identifier: Apache-2.0
#include "launch/record/energy_meter.h"

#include <fstream>
#include <string>

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr double kJoulesPerMicrojoule = 1e-6, kJoulesPerWattHour = 3600;

std::optional<uint64_t> ReadNumber(const fs::path& file) {
  uint64_t number = 0;
  std::ifstream in(file);
  return in >> number ? std::optional(number) : std::nullopt;
}

// "intel-rapl:0" is a package or the whole platform, "intel-rapl:0:0" a part of a package. The
// platform ("psys") contains the packages.
bool IsPackage(const fs::path& folder) {
  const std::string name = folder.filename();
  if (!name.starts_with("intel-rapl:") || name.find(':') != name.rfind(':')) return false;
  std::string kind;
  std::ifstream(folder / "name") >> kind;
  return kind.starts_with("package");
}

}  // namespace

EnergyMeter::EnergyMeter(const fs::path& powercap) {
  std::error_code error;
  for (fs::directory_iterator it(powercap, error), end; !error && it != end; it.increment(error)) {
    if (!IsPackage(it->path())) continue;
    const fs::path counter = it->path() / "energy_uj";
    const auto range = ReadNumber(it->path() / "max_energy_range_uj"), now = ReadNumber(counter);
    if (!range || !now) {  // the energy of the other packages alone would be too small
      packages_.clear();
      return;
    }
    packages_.push_back({.counter = counter, .range = *range, .last = *now});
  }
}

void EnergyMeter::Sample() {
  for (Package& package : packages_) {
    const auto now = ReadNumber(package.counter);
    if (!now) {
      packages_.clear();
      return;
    }
    // A counter that has reached its range continues at 0.
    const uint64_t grown =
        *now >= package.last ? *now - package.last : package.range - package.last + *now;
    joules_ += kJoulesPerMicrojoule * static_cast<double>(grown);
    package.last = *now;
  }
}

std::optional<double> EnergyMeter::WattHours() const {
  if (packages_.empty()) return std::nullopt;
  return joules_ / kJoulesPerWattHour;
}

}  // namespace shoal::launch
