// SPDX-License-Identifier: Apache-2.0
// The smoke run: runs a fuzz target on the files of its corpus, without libFuzzer. The input of a
// fixed finding is added to the corpus.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "common/base/files.h"
#include "common/base/main_guard.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

void RunOn(std::string content) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(content.data()), content.size());
}

int Run(int argc, char** argv) {
  int inputs = 0;
  for (int i = 1; i < argc; ++i) {
    for (const auto& entry : std::filesystem::directory_iterator(argv[i])) {
      const std::string content = shoal::ReadFile(entry.path());
      RunOn(content);
      // Also runs the file cut short and with a flipped bit, which must not fail either.
      for (size_t part = 1; part <= 8; ++part) RunOn(content.substr(0, content.size() * part / 9));
      for (size_t at = 0; at < content.size(); at += std::max<size_t>(1, content.size() / 16)) {
        std::string flipped = content;
        flipped[at] = static_cast<char>(flipped[at] ^ (1 << at % 8));
        RunOn(flipped);
      }
      ++inputs;
    }
  }
  std::printf("%d inputs\n", inputs);
  return inputs > 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return shoal::GuardMain("replay_corpus", [&] { return Run(argc, argv); });
}
