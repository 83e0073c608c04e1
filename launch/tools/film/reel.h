// SPDX-License-Identifier: Apache-2.0
// Makes a film from streams of frames, one after the other.
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

// The frame rate of the film is the rate of env steps in simulated time, so that the robot moves at
// its real speed. If a task has more than 50 env steps a second, the film shows every n-th step (n
// = 2, 3, ...) and the last step of an episode. The last picture of an episode stays for half a
// second. One thread at a time.
class FilmReel {
 public:
  // `spec`: observation spec of the policies of all streams.
  FilmReel(const ObservationSpec& spec, const std::filesystem::path& output);

  // Adds a stream of `episodes` whole episodes, read to its end from a file or pipe. Unless `strip`
  // is null, the pictures of the first episode are also added to `strip`. Throws Error if the
  // stream is broken, ends early, or has sizes other than those of the spec and of kFilmView.
  void Add(const std::filesystem::path& stream, const std::string& subtitle, uint32_t episodes,
           FilmStrip* strip = nullptr);
  // Completes the file. Call it after at least one stream.
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
  std::optional<Mp4Writer> file_;  // set by the first stream, whose header has the rate
};

}  // namespace shoal::launch
