// SPDX-License-Identifier: Apache-2.0
#include "launch/commands/json_output.h"

#include <utility>

#include "common/base/files.h"

namespace shoal::launch {

JsonOutput::JsonOutput(std::string file, Readers readers)
    : file_(std::move(file)), readers_(readers) {
  if (!file_.empty() && !OnStdout()) CheckWritable(file_);
}

void JsonOutput::WriteEarly(const std::string& json) const {
  if (!OnStdout()) Write(json);
}

void JsonOutput::Write(const std::string& json) const {
  if (file_.empty()) return;
  if (OnStdout()) {
    std::fwrite(json.data(), 1, json.size(), stdout);
    std::fflush(stdout);
  } else if (readers_ == Readers::kOthers) {
    WriteFileForOthers(file_, json);
  } else {
    WriteFileAtomically(file_, json);
  }
}

}  // namespace shoal::launch
