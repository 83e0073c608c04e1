// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/mp4_writer.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr char kEncoder[] = "libx264";
// Constant quality of x264, 0 (lossless) to 51. At this value text of 14 pixels has clean edges.
constexpr char kQuality[] = "23";

struct Free {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
  void operator()(AVFormatContext* format) const {
    avio_closep(&format->pb);
    avformat_free_context(format);
  }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

std::string Reason(int error) {
  char text[AV_ERROR_MAX_STRING_SIZE];
  return av_make_error_string(text, sizeof text, error);
}

// A file under a temporary name, and its folder if that had to be made. The destructor removes both
// unless Keep was called.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(const fs::path& path)
      : path_(path),
        folder_(path.has_parent_path() ? path.parent_path() : "."),
        temporary_(path.string() + ".tmp-" + std::to_string(getpid())),
        made_folder_(!fs::exists(folder_)) {
    MakeFolders(folder_);
  }
  ~UnfinishedFile() {
    std::error_code error;
    if (kept_) return;
    fs::remove(temporary_, error);
    if (made_folder_) fs::remove(folder_, error);  // fails if it is not empty
  }
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const fs::path& path() const { return path_; }
  // The file's name for libav, with a protocol: without one, libav would look for one in the name.
  std::string Url() const { return "file:" + temporary_.string(); }
  void Keep() {
    OpenToOthers(temporary_);  // films are shared with other users
    if (rename(temporary_.c_str(), path_.c_str()) != 0) {
      throw RuntimeError("cannot write '{}': {}", path_.string(), std::strerror(errno));
    }
    kept_ = true;
    SyncFolder(folder_);
  }

 private:
  const fs::path path_, folder_, temporary_;
  const bool made_folder_;
  bool kept_ = false;
};

}  // namespace

struct Mp4Writer::Encoder {
  Encoder(const fs::path& path, int width, int height, uint32_t microseconds) : file(path) {
    av_log_set_level(AV_LOG_QUIET);
    OpenCodec(width, height, microseconds);
    OpenFormat();
    frame.reset(av_frame_alloc());
    packet.reset(av_packet_alloc());
    scaler.reset(sws_getContext(width, height, AV_PIX_FMT_BGR0, width, height, codec->pix_fmt,
                                SWS_BICUBIC | SWS_ACCURATE_RND, nullptr, nullptr, nullptr));
    CHECK(frame && packet && scaler) << width << " x " << height;
    frame->format = codec->pix_fmt;
    frame->width = width;
    frame->height = height;
    Must(av_frame_get_buffer(frame.get(), 0));
  }

  // Throws Error naming the film for libav's error codes.
  void Must(int result) const {
    if (result >= 0) return;
    throw RuntimeError("cannot write '{}': {}", file.path().string(), Reason(result));
  }

  void OpenCodec(int width, int height, uint32_t microseconds) {
    const AVCodec* const encoder = avcodec_find_encoder_by_name(kEncoder);
    if (encoder == nullptr) {
      throw RuntimeError("cannot write '{}': this libavcodec has no {}", file.path().string(),
                         kEncoder);
    }
    codec.reset(avcodec_alloc_context3(encoder));
    CHECK(codec != nullptr);
    codec->width = width;
    codec->height = height;
    codec->pix_fmt = AV_PIX_FMT_YUV420P;  // every browser decodes this format
    av_reduce(&codec->time_base.num, &codec->time_base.den, microseconds, 1'000'000, 1'000'000);
    codec->framerate = av_inv_q(codec->time_base);
    // The range that swscale produces from RGB.
    codec->color_range = AVCOL_RANGE_MPEG;
    codec->colorspace = AVCOL_SPC_SMPTE170M;
    codec->thread_count = 1;  // a film is small, and others may be training on these cores
    codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;  // required by MP4
    Must(av_opt_set(codec->priv_data, "crf", kQuality, 0));
    Must(av_opt_set(codec->priv_data, "preset", "medium", 0));
    Must(avcodec_open2(codec.get(), encoder, nullptr));
  }

  void OpenFormat() {
    const std::string url = file.Url();
    AVFormatContext* made = nullptr;
    Must(avformat_alloc_output_context2(&made, nullptr, "mp4", url.c_str()));
    format.reset(made);
    stream = avformat_new_stream(format.get(), nullptr);
    CHECK(stream != nullptr);
    Must(avcodec_parameters_from_context(stream->codecpar, codec.get()));
    stream->time_base = codec->time_base;
    stream->avg_frame_rate = codec->framerate;
    Must(avio_open(&format->pb, url.c_str(), AVIO_FLAG_WRITE));
    // Lets browsers start to play before they have the whole file.
    Must(av_opt_set(format->priv_data, "movflags", "+faststart", 0));
    Must(avformat_write_header(format.get(), nullptr));
  }

  // Null ends the stream.
  void Send(const AVFrame* next) {
    Must(avcodec_send_frame(codec.get(), next));
    while (true) {
      const int result = avcodec_receive_packet(codec.get(), packet.get());
      if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
      Must(result);
      packet->stream_index = stream->index;
      packet->duration = 1;
      av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
      Must(av_interleaved_write_frame(format.get(), packet.get()));
    }
  }

  UnfinishedFile file;  // first, so it is removed after libav has closed it
  Owned<AVCodecContext> codec;
  Owned<AVFormatContext> format;
  AVStream* stream = nullptr;  // owned by format
  Owned<AVFrame> frame;
  Owned<AVPacket> packet;
  Owned<SwsContext> scaler;
  uint64_t frames = 0;
};

Mp4Writer::Mp4Writer(const fs::path& path, int width, int height, uint32_t microseconds)
    : encoder_(std::make_unique<Encoder>(path, width, height, microseconds)) {}

Mp4Writer::~Mp4Writer() = default;

void Mp4Writer::Add(std::span<const uint8_t> pixels, int stride) {
  Encoder& encoder = *encoder_;
  AVFrame* const frame = encoder.frame.get();
  CHECK(pixels.size() == size_t(stride) * size_t(frame->height)) << pixels.size();
  encoder.Must(av_frame_make_writable(frame));  // the encoder may still read the frame before
  const uint8_t* const planes[] = {pixels.data()};
  const int strides[] = {stride};
  sws_scale(encoder.scaler.get(), planes, strides, 0, frame->height, frame->data, frame->linesize);
  frame->pts = int64_t(encoder.frames++);
  encoder.Send(frame);
}

uint64_t Mp4Writer::frames() const { return encoder_->frames; }

void Mp4Writer::Finish() {
  Encoder& encoder = *encoder_;
  CHECK(encoder.frames > 0);
  encoder.Send(nullptr);
  encoder.Must(av_write_trailer(encoder.format.get()));
  encoder.Must(avio_closep(&encoder.format->pb));  // a full disk may show here
  encoder.file.Keep();
}

}  // namespace shoal::launch
