// SPDX-License-Identifier: Apache-2.0
#include "launch/record/energy_meter.h"

#include <gtest/gtest.h>

#include <string>

#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kWattHour = 3'600'000'000;  // in microjoules

class EnergyMeterTest : public testing::Test {
 protected:
  void Set(const std::string& folder, uint64_t microjoules) {
    WriteFileAtomically(powercap_.path() / folder / "energy_uj",
                        std::to_string(microjoules) + "\n");
  }
  void Add(const std::string& folder, const std::string& name, uint64_t microjoules,
           uint64_t range = 100 * kWattHour) {
    fs::create_directories(powercap_.path() / folder);
    WriteFileAtomically(powercap_.path() / folder / "name", name + "\n");
    WriteFileAtomically(powercap_.path() / folder / "max_energy_range_uj",
                        std::to_string(range) + "\n");
    Set(folder, microjoules);
  }

  const TemporaryFolder powercap_;
};

TEST_F(EnergyMeterTest, SumsThePackagesWithoutTheirPartsAndThePlatform) {
  Add("intel-rapl:0", "package-0", 5 * kWattHour);
  Add("intel-rapl:1", "package-1", 0);
  Add("intel-rapl:0:0", "core", 0);
  Add("intel-rapl:2", "psys", 0);
  EnergyMeter meter(powercap_.path());
  EXPECT_EQ(meter.WattHours(), 0);
  Set("intel-rapl:0", 7 * kWattHour);
  Set("intel-rapl:1", 1 * kWattHour);
  Set("intel-rapl:0:0", 50 * kWattHour);
  Set("intel-rapl:2", 50 * kWattHour);
  meter.Sample();
  ASSERT_TRUE(meter.WattHours());
  EXPECT_NEAR(*meter.WattHours(), 3, 1e-9);
}

TEST_F(EnergyMeterTest, ACounterThatHasReachedItsRangeContinuesAtZero) {
  Add("intel-rapl:0", "package-0", 99 * kWattHour);
  EnergyMeter meter(powercap_.path());
  Set("intel-rapl:0", 3 * kWattHour);
  meter.Sample();
  Set("intel-rapl:0", 4 * kWattHour);
  meter.Sample();
  ASSERT_TRUE(meter.WattHours());
  EXPECT_NEAR(*meter.WattHours(), 5, 1e-9);
}

TEST_F(EnergyMeterTest, AHostWithoutCountersHasNoEnergy) {
  EXPECT_FALSE(EnergyMeter(powercap_.path() / "absent").WattHours());
  Add("intel-rapl:0:0", "core", 0);
  EXPECT_FALSE(EnergyMeter(powercap_.path()).WattHours());
}

TEST_F(EnergyMeterTest, AnUnreadablePackageEndsTheCount) {
  Add("intel-rapl:0", "package-0", 0);
  Add("intel-rapl:1", "package-1", 0);
  EnergyMeter meter(powercap_.path());
  fs::remove(powercap_.path() / "intel-rapl:1" / "energy_uj");
  EXPECT_FALSE(EnergyMeter(powercap_.path()).WattHours());
  meter.Sample();
  EXPECT_FALSE(meter.WattHours());
}

}  // namespace
}  // namespace shoal::launch
