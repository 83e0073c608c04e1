// SPDX-License-Identifier: Apache-2.0
// Writes scalars, texts, images and hyper-parameters to a TensorBoard event file.
//
// The file FOLDER/events.out.tfevents.SECONDS.HOST.PID.NUMBER is a sequence of TFRecords with Event
// messages. TensorBoard follows only the newest file of a folder, so only one process at a time may
// write event files to a folder.
//
// Records are kept in memory until Flush. After a Flush the file ends with a complete record. Only
// if the process dies during a write, or if the disk is full, the file may end with a part of a
// record; readers ignore this part. Threads: one at a time. Throws Error naming the file if the
// file cannot be made or flushed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <variant>

#include "common/base/descriptor.h"

namespace shoal::tensorboard {

using HyperParameter = std::variant<bool, double, std::string>;

class EventWriter {
 public:
  // Makes the folder and a new file in it.
  explicit EventWriter(const std::filesystem::path& folder);
  // Writes the pending events. A failure is logged.
  ~EventWriter();
  EventWriter(const EventWriter&) = delete;
  EventWriter& operator=(const EventWriter&) = delete;

  // One point: x = `step` (env steps everywhere in Shoal), y = `value` rounded to float.
  void Scalar(const std::string& tag, int64_t step, double value);
  // A text in markdown, for the text tab.
  void Text(const std::string& tag, const std::string& markdown);
  // An RGB image of `width` x `height` pixels as a PNG file's bytes, for the images tab.
  void Image(const std::string& tag, int64_t step, int width, int height, const std::string& png);
  // Begins one line of the hparams tab. `settings`: hyper-parameters by name.
  void BeginSession(const std::map<std::string, HyperParameter>& settings);
  // Ends this line, as successful or as failed.
  void EndSession(bool success);
  // Writes the pending events. Throws Error if the file cannot be written now; a later call
  // continues where this call failed. If more than kMostPending bytes are pending, further events
  // are dropped.
  void Flush();

  static constexpr size_t kMostPending = 32 * 1024 * 1024;

  const std::filesystem::path& path() const { return path_; }

 private:
  void Append(const std::string& event);

  std::filesystem::path path_;
  Descriptor file_;
  std::string pending_;
};

}  // namespace shoal::tensorboard
