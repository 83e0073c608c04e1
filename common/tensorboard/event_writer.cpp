// SPDX-License-Identifier: Apache-2.0
#include "common/tensorboard/event_writer.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "common/base/clock.h"
#include "common/base/disk_steps.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/host_name.h"
#include "common/base/log.h"
#include "common/tensorboard/event.pb.h"
#include "common/tensorboard/tf_record.h"

namespace shoal::tensorboard {
namespace {

std::string FileName() {
  // Distinguishes the files that one process makes within one second.
  static std::atomic<int> files{0};
  return fmt::format("events.out.tfevents.{:010}.{}.{}.{}", WallTimeNs() / 1'000'000'000,
                     HostName(), getpid(), files++);
}

proto::Event EventOfNow(int64_t step = 0) {
  proto::Event event;
  event.set_wall_time(WallTimeSeconds());
  if (step != 0) event.set_step(step);
  return event;
}

// Adds the value of a plugin, which has no scalar.
proto::Summary::Value* AddPluginValue(proto::Event* event, const std::string& tag,
                                      const std::string& plugin, const std::string& content) {
  proto::Summary::Value* value = event->mutable_summary()->add_value();
  value->set_tag(tag);
  proto::SummaryMetadata::PluginData* data = value->mutable_metadata()->mutable_plugin_data();
  data->set_plugin_name(plugin);
  data->set_content(content);
  return value;
}

std::string SessionEvent(const std::string& tag, const proto::HParamsPluginData& data) {
  proto::Event event = EventOfNow();
  AddPluginValue(&event, "_hparams_/" + tag, "hparams", data.SerializeAsString());
  return event.SerializeAsString();
}

proto::HyperParameter ToProto(const HyperParameter& value) {
  proto::HyperParameter parameter;
  if (const auto* text = std::get_if<std::string>(&value)) {
    parameter.set_string_value(*text);
  } else if (const auto* number = std::get_if<double>(&value)) {
    parameter.set_number_value(*number);
  } else {
    parameter.set_bool_value(std::get<bool>(value));
  }
  return parameter;
}

}  // namespace

EventWriter::EventWriter(const std::filesystem::path& folder) : path_(folder / FileName()) {
  MakeFolders(folder);
  file_ = Descriptor(open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666));
  if (file_.get() < 0) {
    throw RuntimeError("cannot create '{}': {}", path_.string(), std::strerror(errno));
  }
  proto::Event event = EventOfNow();
  event.set_file_version("brain.Event:2");
  Append(event.SerializeAsString());
}

EventWriter::~EventWriter() {
  try {
    Flush();
  } catch (const Error& e) {
    log::Failure("{}", e.what());
  }
}

void EventWriter::Scalar(const std::string& tag, int64_t step, double value) {
  proto::Event event = EventOfNow(step);
  proto::Summary::Value* point = event.mutable_summary()->add_value();
  point->set_tag(tag);
  point->set_simple_value(static_cast<float>(value));
  Append(event.SerializeAsString());
}

void EventWriter::Text(const std::string& tag, const std::string& markdown) {
  constexpr int kStrings = 7;
  proto::Event event = EventOfNow();
  proto::Tensor* text = AddPluginValue(&event, tag, "text", "")->mutable_tensor();
  text->set_dtype(kStrings);
  text->mutable_tensor_shape()->add_dim()->set_size(1);
  text->add_string_val(markdown);
  Append(event.SerializeAsString());
}

void EventWriter::Image(const std::string& tag, int64_t step, int width, int height,
                        const std::string& png) {
  constexpr int kRgb = 3;
  proto::Event event = EventOfNow(step);
  proto::Summary::Value* value = event.mutable_summary()->add_value();
  value->set_tag(tag);
  value->mutable_image()->set_width(width);
  value->mutable_image()->set_height(height);
  value->mutable_image()->set_colorspace(kRgb);
  value->mutable_image()->set_encoded_image_string(png);
  Append(event.SerializeAsString());
}

void EventWriter::BeginSession(const std::map<std::string, HyperParameter>& settings) {
  proto::HParamsPluginData data;
  proto::SessionStartInfo* start = data.mutable_session_start_info();
  for (const auto& [name, value] : settings) (*start->mutable_hparams())[name] = ToProto(value);
  start->set_start_time_secs(WallTimeSeconds());
  Append(SessionEvent("session_start_info", data));
}

void EventWriter::EndSession(bool success) {
  proto::HParamsPluginData data;
  data.mutable_session_end_info()->set_status(success ? 1 : 2);
  data.mutable_session_end_info()->set_end_time_secs(WallTimeSeconds());
  Append(SessionEvent("session_end_info", data));
}

void EventWriter::Append(const std::string& event) {
  // Drops events if too many are pending because the file cannot be written.
  if (pending_.size() + event.size() <= kMostPending) AppendTfRecord(event, &pending_);
}

void EventWriter::Flush() {
  size_t done = 0;
  int error = pending_.empty() ? 0 : DiskStep(path_);
  while (done < pending_.size() && error == 0) {
    const ssize_t n = write(file_.get(), pending_.data() + done, pending_.size() - done);
    if (n >= 0) done += static_cast<size_t>(n);
    if (n < 0 && errno != EINTR) error = errno;
  }
  pending_.erase(0, done);
  if (error != 0) {
    throw RuntimeError("cannot write '{}': {}", path_.string(), std::strerror(error));
  }
}

}  // namespace shoal::tensorboard
