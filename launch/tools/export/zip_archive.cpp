// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/zip_archive.h"

#include <cstdint>
#include <limits>
#include <span>

#include "common/base/crc32.h"
#include "common/base/error.h"

namespace shoal::launch {
namespace {

constexpr uint32_t kLocalHeader = 0x04034b50, kCentralHeader = 0x02014b50, kEnd = 0x06054b50;
constexpr uint16_t kVersion = 10, kStored = 0;
constexpr uint16_t kMidnight = 0, kFirstDay = (1 << 5) | 1;  // 1980-01-01

void Put(uint64_t value, int bytes, std::string* out) {
  for (int i = 0; i < bytes; ++i) out->push_back(char(value >> (8 * i) & 0xff));
}

// The common part of both headers of a file, from "version needed to extract" on.
std::string FileFields(const std::string& name, const std::string& content) {
  std::string fields;
  Put(kVersion, 2, &fields);
  Put(0, 2, &fields);  // flags
  Put(kStored, 2, &fields);
  Put(kMidnight, 2, &fields);
  Put(kFirstDay, 2, &fields);
  Put(Crc32({reinterpret_cast<const uint8_t*>(content.data()), content.size()}), 4, &fields);
  Put(content.size(), 4, &fields);  // compressed
  Put(content.size(), 4, &fields);
  Put(name.size(), 2, &fields);
  Put(0, 2, &fields);  // extra fields
  return fields;
}

}  // namespace

std::string WriteZip(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string archive, directory;
  for (const auto& [name, content] : files) {
    const size_t offset = archive.size();
    if (offset + content.size() > std::numeric_limits<uint32_t>::max() / 2) {
      throw RuntimeError("{} is too large for a zip archive: expected less than 2 GB", name);
    }
    const std::string fields = FileFields(name, content);
    Put(kLocalHeader, 4, &archive);
    archive += fields + name + content;
    Put(kCentralHeader, 4, &directory);
    Put(kVersion, 2, &directory);  // made by
    directory += fields;
    Put(0, 2, &directory);  // comment
    Put(0, 2, &directory);  // disk
    Put(0, 2, &directory);  // internal attributes
    Put(0, 4, &directory);  // external attributes
    Put(offset, 4, &directory);
    directory += name;
  }
  const size_t start = archive.size();
  archive += directory;
  Put(kEnd, 4, &archive);
  Put(0, 2, &archive);  // this disk
  Put(0, 2, &archive);  // disk of the directory
  Put(files.size(), 2, &archive);
  Put(files.size(), 2, &archive);
  Put(directory.size(), 4, &archive);
  Put(start, 4, &archive);
  Put(0, 2, &archive);  // comment
  return archive;
}

}  // namespace shoal::launch
