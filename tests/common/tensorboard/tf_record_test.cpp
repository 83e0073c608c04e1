// SPDX-License-Identifier: Apache-2.0
#include "common/tensorboard/tf_record.h"

#include <gtest/gtest.h>

#include <string>

namespace shoal::tensorboard {
namespace {

TEST(TfRecord, FramesAPayloadInGoldenBytes) {
  std::string file = "before";
  AppendTfRecord("123456789", &file);
  const char golden[] =
      "before"
      "\t\0\0\0\0\0\0\0"  // length
      "7\xf9q9"           // masked CRC of the length
      "123456789"
      "\xe5\xb0\x8a\xc7";  // masked CRC of the payload
  EXPECT_EQ(file, std::string(golden, sizeof golden - 1));
}

}  // namespace
}  // namespace shoal::tensorboard
