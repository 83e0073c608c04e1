// SPDX-License-Identifier: Apache-2.0
#include "common/nn/precision.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"

namespace shoal::nn {
namespace {

TEST(Precision, AutoIsBf16ForPixelsExactlyWhereTheInstructionSetHasIt) {
  const std::string isa = CpuIsa();
  const bool native = isa == "avx512_core_bf16" || isa == "avx512_core_amx";
  EXPECT_EQ(ChoosePrecision("auto", /*pixels=*/true), native ? Precision::kBf16 : Precision::kF32)
      << isa;
  if (native) {
    EXPECT_EQ(ChoosePrecision("bf16", /*pixels=*/false), Precision::kBf16);
  } else {
    EXPECT_THROW(ChoosePrecision("bf16", /*pixels=*/false), Error);
  }
}

TEST(Precision, AutoIsF32WithoutPixels) {
  EXPECT_EQ(ChoosePrecision("auto", /*pixels=*/false), Precision::kF32);
}

TEST(Precision, F32IsAlwaysToBeHadAndOtherWordsAreBadUsage) {
  EXPECT_EQ(ChoosePrecision("f32", /*pixels=*/true), Precision::kF32);
  try {
    ChoosePrecision("f16", /*pixels=*/true);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), testing::HasSubstr("f16"));
  }
}

TEST(Precision, NamesAreThoseOfTheConfiguration) {
  EXPECT_STREQ(ToString(Precision::kF32), "f32");
  EXPECT_STREQ(ToString(Precision::kBf16), "bf16");
}

}  // namespace
}  // namespace shoal::nn
