// SPDX-License-Identifier: Apache-2.0
#include "common/base/program_file.h"

#include <algorithm>
#include <cerrno>
#include <string_view>

#include "common/base/error.h"
#include "common/base/files.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kLoader = "ld-linux";  // on any architecture; a version follows
constexpr std::string_view kName = "--argv0";

fs::path Executable() {
  std::error_code error;
  fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (error) throw RuntimeError("cannot read /proc/self/exe: {}", error.message());
  return executable;
}

bool IsLoader(const fs::path& executable) {
  return executable.filename().string().starts_with(kLoader);
}

}  // namespace

fs::path ProgramFile() { return ProgramFileOf(Executable(), program_invocation_short_name); }

std::vector<std::string> ProgramWords() {
  return ProgramWordsOf(Executable(), ReadFile("/proc/self/cmdline"));
}

fs::path ProgramFileOf(const fs::path& executable, const std::string& name) {
  if (!IsLoader(executable)) return executable;
  return executable.parent_path().parent_path() / "bin" / name;
}

std::vector<std::string> ProgramWordsOf(const fs::path& executable,
                                        const std::string& command_line) {
  std::vector<std::string> words;
  for (size_t at = 0, end = 0; at < command_line.size(); at = end + 1) {
    end = std::min(command_line.find('\0', at), command_line.size());
    words.push_back(command_line.substr(at, end - at));
  }
  if (!IsLoader(executable)) return words;
  // The loader's options end with the name. The program's file follows and is not one of its words.
  const auto option = std::ranges::find(words, kName);
  if (words.end() - option < 3) return words;
  std::vector<std::string> own{option[1]};
  own.insert(own.end(), option + 3, words.end());
  return own;
}

}  // namespace shoal
