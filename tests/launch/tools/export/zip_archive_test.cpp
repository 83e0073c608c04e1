// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/zip_archive.h"

#include <gtest/gtest.h>

#include <string_view>

namespace shoal::launch {
namespace {

using std::string_view_literals::operator""sv;

// python3 -m zipfile reads these bytes; CRC-32 of "hello" is 3610a686.
TEST(ZipArchive, HasTheFormatsBytes) {
  const std::string_view local =
      "PK\3\4\x0a\0\0\0\0\0\0\0\x21\0\x86\xa6\x10\x36\5\0\0\0\5\0\0\0\5\0\0\0a.txthello"sv;
  const std::string_view central =
      "PK\1\2\x0a\0\x0a\0\0\0\0\0\0\0\x21\0\x86\xa6\x10\x36\5\0\0\0\5\0\0\0\5\0\0\0"
      "\0\0\0\0\0\0\0\0\0\0\0\0\0\0a.txt"sv;
  const std::string_view end = "PK\5\6\0\0\0\0\1\0\1\0\x33\0\0\0\x28\0\0\0\0\0"sv;
  EXPECT_EQ(WriteZip({{"a.txt", "hello"}}),
            std::string(local) + std::string(central) + std::string(end));
}

TEST(ZipArchive, TheDirectorySaysWhereEachFileIs) {
  const std::string archive = WriteZip({{"a", "12345"}, {"b", ""}});
  const size_t second = archive.find("PK\3\4"sv, 1);
  EXPECT_EQ(second, 30u + 1 + 5);
  const size_t directory = archive.find("PK\1\2"sv),
               entry = archive.find("PK\1\2"sv, directory + 1);
  EXPECT_EQ(archive[directory + 42], 0);
  EXPECT_EQ(size_t(archive[entry + 42]), second);
  EXPECT_EQ(size_t(archive[archive.size() - 6]), directory);
}

}  // namespace
}  // namespace shoal::launch
