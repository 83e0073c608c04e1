// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz_target.h"

#include <fstream>

#include "common/base/check.h"
#include "common/base/error.h"
#include "tests/support/temporary_folder.h"

namespace shoal::fuzz {
namespace {

namespace fs = std::filesystem;

fs::path InMemory() {
  const fs::path memory = "/dev/shm";
  std::error_code error;
  return fs::is_directory(memory, error) ? memory : fs::temp_directory_path();
}

// An Error would pass for a refusal of the bytes: it ends the program.
const TemporaryFolder& ScratchFolder() noexcept {
  static const TemporaryFolder folder("shoal-fuzz-", InMemory());
  return folder;
}

}  // namespace

void CheckOneLine(std::string_view message) {
  CHECK(!message.empty());
  CHECK(message.find('\n') == std::string_view::npos) << message;
}

int Try(const uint8_t* data, size_t size,
        const std::function<void(uint8_t which, const std::string& bytes)>& read) {
  if (size == 0) return 0;
  try {
    read(data[0], Text(data + 1, size - 1));
  } catch (const Error& e) {
    CheckOneLine(e.what());
  }
  return 0;
}

const fs::path& Scratch() { return ScratchFolder().path(); }

void WriteScratch(const fs::path& file, std::string_view content) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
}

}  // namespace shoal::fuzz
