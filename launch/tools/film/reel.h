// SPDX-License-Identifier: Apache-2.0
// Makes a film of streams of frames, one after the other.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/image/frame_stream.h"
#include "common/spec/observation_spec.h"
#include "launch/tools/film/film_strip.h"
#include "launch/tools/film/mp4_writer.h"
#include "launch/tools/film/picture.h"

namespace shoal::launch {

// The film's rate is that of the env steps in the world, so that it plays as fast as the robot
// moves; of tasks with more than 50 a second it shows every second, third, ... step and the last.
// An episode's last picture stays for half a second. One thread at a time.
class FilmReel {
 public:
  // `spec`: what the policy of every stream observes.
  FilmReel(const ObservationSpec& spec, const std::filesystem::path& output);

  // Adds a stream of `episodes` whole episodes, read to its end from a file or pipe. Throws Error
  // where it is broken, ends early, or is of other sizes than those of the spec and of kFilmView.
  // The pictures of its first episode also go into `strip`, unless that is null.
  void Add(const std::filesystem::path& stream, const std::string& subtitle, uint32_t episodes,
           FilmStrip* strip = nullptr);
  // Completes the file, after at least one stream.
  void Finish();

  uint64_t frames() const;
  double seconds() const;

 private:
  void Begin(const image::FrameStreamHeader& header);
  void Show(const image::ShownFrame& frame, FilmStrip* strip);

  const ObservationSpec spec_;
  const std::filesystem::path output_;
  FilmPicture picture_;
  FilmText text_;
  uint32_t stride_ = 1;  // env steps from one picture to the next
  uint32_t picture_microseconds_ = 0;
  std::optional<Mp4Writer> file_;  // since the first stream, which says the rate
};

}  // namespace shoal::launch
