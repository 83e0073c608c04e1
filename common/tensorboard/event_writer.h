// SPDX-License-Identifier: Apache-2.0
// Scalars, texts, images and hyper-parameters as a TensorBoard event file.
//
// The file is FOLDER/events.out.tfevents.SECONDS.HOST.PID.NUMBER, a sequence of TFRecords of Event
// messages. TensorBoard follows the newest file of a folder only, so one process at a time writes
// there.
//
// Records are kept in memory until Flush. A file always ends at a record's end, unless the
// process dies within a write or the disk is full; readers ignore such a tail. Threads: one at a
// time. Errors: Error naming the file when it cannot be made or flushed.
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
  // Writes what is pending; a failure is logged.
  ~EventWriter();
  EventWriter(const EventWriter&) = delete;
  EventWriter& operator=(const EventWriter&) = delete;

  // One point: x = `step` (env steps everywhere in Shoal), y = `value` rounded to float.
  void Scalar(const std::string& tag, int64_t step, double value);
  // A text in markdown, for the text tab.
  void Text(const std::string& tag, const std::string& markdown);
  // An RGB image of `width` x `height` pixels as a PNG file's bytes, for the images tab.
  void Image(const std::string& tag, int64_t step, int width, int height, const std::string& png);
  // Begins one line of the hparams tab, with the settings by name.
  void BeginSession(const std::map<std::string, HyperParameter>& settings);
  void EndSession(bool success);
  // Writes the pending events. Throws Error when the file cannot be written now; a later call
  // continues where this call failed. Meanwhile, events beyond kMostPending bytes are dropped.
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
