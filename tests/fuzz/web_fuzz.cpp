// SPDX-License-Identifier: Apache-2.0
// Input of the page from any client: bytes are refused or valid. First byte: the kind of input.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/check.h"
#include "launch/tools/web/access.h"
#include "launch/tools/web/byte_range.h"
#include "launch/tools/web/page_answers.h"
#include "launch/tools/web/page_route.h"
#include "launch/tools/web/run_curves.h"
#include "launch/tools/web/served_file.h"
#include "tests/fuzz/fuzz_target.h"

namespace shoal {
namespace {

using namespace launch;

void CheckRange(const std::string& header) {
  constexpr uint64_t kSizes[] = {0, 1, 1000, UINT64_MAX};
  for (const uint64_t size : kSizes) {
    ByteRange range;
    if (ParseByteRange(header, size, &range) != RangeAsked::kPart) continue;
    CHECK(range.bytes > 0 && range.offset < size && range.bytes <= size - range.offset) << header;
  }
}

// For any path at most the one existing file is served.
void CheckFile(const std::string& path) {
  const std::filesystem::path run = fuzz::Scratch() / "run";
  std::filesystem::create_directories(run / "videos");
  fuzz::WriteScratch(run / "videos" / "a.mp4", "film");
  fuzz::WriteScratch(fuzz::Scratch() / "a.mp4", "secret");
  const auto file = OpenServedFile(run, path);
  CHECK(!file || (path == "videos/a.mp4" && file->bytes == 4)) << path;
}

void Read(uint8_t which, const std::string& bytes) {
  switch (which % 6) {
    case 0:
      for (const bool acts : {false, true}) {
        const PageRoute route = ParsePageRoute(acts, bytes);
        CHECK(route.run.find('/') == std::string::npos) << bytes;
        CHECK(std::ranges::count(route.file, '/') <= 1) << bytes;
      }
      break;
    case 1:
      ParsePageOrder(bytes);
      break;
    case 2:
      CheckRange(bytes);
      break;
    case 3:
      CheckFile(bytes);
      break;
    case 4: {
      const std::string token(32, 'a');
      const Gate gate({.address = "127.0.0.1", .port = 1}, token);
      const std::string cookie(CookieValue(bytes, "shoal_token_1"));
      Caller caller;
      caller.acts = true;
      caller.host = caller.origin = bytes;
      caller.header_token = cookie;
      CHECK(gate.Decide(caller) != Access::kAllowed || cookie == token);
      break;
    }
    case 5: {
      fuzz::WriteScratch(fuzz::Scratch() / "metrics.jsonl", bytes);
      RunCurves curves(fuzz::Scratch());
      curves.ReadOn();
      CHECK(nlohmann::json::accept(curves.Json()));
      break;
    }
  }
}

}  // namespace
}  // namespace shoal

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return shoal::fuzz::Try(data, size, shoal::Read);
}
