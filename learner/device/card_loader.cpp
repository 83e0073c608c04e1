// SPDX-License-Identifier: Apache-2.0
#include "learner/device/card_loader.h"

#include <dlfcn.h>

#include <cstring>
#include <filesystem>
#include <vector>

#include "common/base/error.h"
#include "common/base/program_file.h"

namespace shoal::learner {
namespace {

namespace fs = std::filesystem;

// dlerror's text; its first word is the file that is missing, which may be one that our library
// needs.
std::string LoaderError() {
  const char* text = dlerror();
  return text == nullptr ? "unknown" : text;
}

// First without a folder, so that LD_LIBRARY_PATH comes before the folders of the program.
std::vector<std::string> Candidates() {
  const fs::path programs = ProgramFile().parent_path();
  const fs::path libraries = programs.parent_path() / "lib";
  std::vector<std::string> files{kCardLibrary};
  for (const fs::path& folder : {programs, libraries, libraries / "shoal"}) {
    if (fs::exists(folder / kCardLibrary)) files.push_back((folder / kCardLibrary).string());
  }
  return files;
}

void* Load() {
  const std::string absent = std::string(kCardLibrary) + ": cannot open shared object file";
  for (const std::string& file : Candidates()) {
    if (void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) return library;
    const std::string error = LoaderError();
    if (!error.starts_with(absent)) throw UsageError("cannot load {}: {}", file, error);
  }
  throw UsageError("this build of Shoal has no CUDA: there is no {}; ./run cuda builds it",
                   kCardLibrary);
}

// A library may leave a text without an end.
template <size_t N>
std::string TextOf(const char (&text)[N]) {
  return {text, strnlen(text, N)};
}

OpenedCard Ask(bool open) {
  void* const library = Load();
  const auto function = reinterpret_cast<ShoalOpenCardFunction*>(dlsym(library, kOpenCardFunction));
  if (function == nullptr) {
    throw UsageError("{} has no function {}: it is not a library of Shoal", kCardLibrary,
                     kOpenCardFunction);
  }
  const std::string version = CardLibraryVersion();
  const ShoalCardRequest request{.version = version.c_str(), .open = open ? 1 : 0};
  OpenedCard card;
  function(&request, &card.reply);
  if (const std::string other = TextOf(card.reply.version); other != version) {
    throw UsageError("{} is of build {}, this program of build {}: expected the same build",
                     kCardLibrary, other, version);
  }
  if (const std::string refusal = TextOf(card.reply.refusal); !refusal.empty()) {
    throw UsageError("{}", refusal);
  }
  card.info = {.name = TextOf(card.reply.name),
               .driver = TextOf(card.reply.driver),
               .memory_bytes = card.reply.memory_bytes};
  return card;
}

}  // namespace

std::optional<CardUse> OpenedCard::Look() const {
  CardUse use;
  if (reply.look == nullptr || reply.look(&use) == 0) return std::nullopt;
  return use;
}

CardInfo ProbeCard() { return Ask(/*open=*/false).info; }

OpenedCard OpenCard() { return Ask(/*open=*/true); }

}  // namespace shoal::learner
