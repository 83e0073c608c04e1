// SPDX-License-Identifier: Apache-2.0
// Decodes an MP4 file with libav, for tests.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace shoal::launch {

struct DecodedFilm {
  int width = 0, height = 0;
  std::string codec, pixel_format = {};
  double frames_per_second = 0;
  std::vector<std::vector<uint8_t>> frames;  // brightness (height, width)
};

inline DecodedFilm DecodeFilm(const std::filesystem::path& path) {
  DecodedFilm film;
  AVFormatContext* format = nullptr;
  if (avformat_open_input(&format, path.c_str(), nullptr, nullptr) < 0) {
    ADD_FAILURE() << path << " cannot be opened";
    return film;
  }
  EXPECT_GE(avformat_find_stream_info(format, nullptr), 0);
  EXPECT_EQ(format->nb_streams, 1u);
  if (format->nb_streams == 0) {
    avformat_close_input(&format);
    return film;
  }
  const AVStream* const stream = format->streams[0];
  const AVCodec* const decoder = avcodec_find_decoder(stream->codecpar->codec_id);
  AVCodecContext* codec = avcodec_alloc_context3(decoder);
  avcodec_parameters_to_context(codec, stream->codecpar);
  EXPECT_EQ(avcodec_open2(codec, decoder, nullptr), 0);
  film.width = codec->width;
  film.height = codec->height;
  film.codec = avcodec_get_name(codec->codec_id);
  film.frames_per_second = av_q2d(stream->avg_frame_rate);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  for (bool more = true; more;) {
    more = av_read_frame(format, packet) >= 0;
    EXPECT_EQ(avcodec_send_packet(codec, more ? packet : nullptr), 0);
    av_packet_unref(packet);
    while (avcodec_receive_frame(codec, frame) >= 0) {
      std::vector<uint8_t>& luma = film.frames.emplace_back();
      for (int row = 0; row < frame->height; ++row) {
        const uint8_t* const pixels = frame->data[0] + row * frame->linesize[0];
        luma.insert(luma.end(), pixels, pixels + frame->width);
      }
      film.pixel_format = frame->format == AV_PIX_FMT_YUV420P ? "yuv420p" : "other";
    }
  }
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&codec);
  avformat_close_input(&format);
  return film;
}

}  // namespace shoal::launch
