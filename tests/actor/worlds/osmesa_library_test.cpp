// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/osmesa_library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "common/base/error.h"

namespace shoal::worlds {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(OsmesaLibrary, IsOpenedOnce) {
  EXPECT_EQ(&Osmesa(), &Osmesa());
  EXPECT_NE(Osmesa().create_context, nullptr);
}

TEST(OsmesaLibrary, SaysInOneLineWhatToDoWithoutIt) {
  try {
    OpenOsmesa("libOSMesa-of-another-system.so");
    FAIL() << "opened";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), static_cast<int>(ErrorKind::kRuntime));
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("libOSMesa-of-another-system.so"), HasSubstr("libosmesa6"),
                      HasSubstr("observation.quality=native"), Not(HasSubstr("\n"))));
  }
}

}  // namespace
}  // namespace shoal::worlds
