// SPDX-License-Identifier: MIT
#include "render/movie.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

namespace shaken::render {
namespace {

std::string av_words(int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(code, text.data(), text.size());
  return text.data();
}

struct FreeAv {
  void operator()(AVFormatContext* format) const {
    if (format->pb) avio_closep(&format->pb);
    avformat_free_context(format);
  }
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
template <class T>
using Av = std::unique_ptr<T, FreeAv>;

}  // namespace

struct MovieWriter::Impl {
  std::filesystem::path file, unfinished;
  Av<AVFormatContext> format;
  Av<AVCodecContext> codec;
  Av<AVFrame> frame;
  Av<AVPacket> packet;
  Av<SwsContext> scaler;
  AVStream* stream = nullptr;  // owned by format
  bool finished = false;

  ~Impl() {
    if (finished) return;
    format.reset();
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
  }

  Error failed(const std::string& why) const { return Error{"cannot write " + file.string() + ": " + why}; }

  Result<void> open(int width, int height, double fps, const std::string& title);
  Result<void> encode(const AVFrame* picture);
};

Result<void> MovieWriter::Impl::open(int width, int height, double fps, const std::string& title) {
  AVFormatContext* made = nullptr;
  if (const int code = avformat_alloc_output_context2(&made, nullptr, "mp4", unfinished.c_str()); code < 0) {
    return failed(av_words(code));
  }
  format.reset(made);
  const AVCodec* encoder = avcodec_find_encoder_by_name("libx264");
  if (!encoder) return failed("this libavcodec has no libx264 encoder");
  stream = avformat_new_stream(format.get(), nullptr);
  codec.reset(avcodec_alloc_context3(encoder));
  frame.reset(av_frame_alloc());
  packet.reset(av_packet_alloc());
  if (!stream || !codec || !frame || !packet) return failed("no memory");

  const AVRational rate = av_d2q(fps, 1001000);
  codec->width = width;
  codec->height = height;
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  codec->time_base = av_inv_q(rate);
  codec->framerate = rate;
  codec->gop_size = 60;
  codec->thread_count = 1;
  codec->color_primaries = AVCOL_PRI_BT709;
  codec->color_trc = AVCOL_TRC_BT709;
  codec->colorspace = AVCOL_SPC_BT709;
  codec->color_range = AVCOL_RANGE_MPEG;
  codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  av_opt_set(codec->priv_data, "preset", "veryfast", 0);
  av_opt_set(codec->priv_data, "crf", "20", 0);
  if (const int code = avcodec_open2(codec.get(), encoder, nullptr); code < 0) return failed(av_words(code));

  stream->time_base = codec->time_base;
  stream->avg_frame_rate = rate;
  avcodec_parameters_from_context(stream->codecpar, codec.get());
  if (!title.empty()) av_dict_set(&format->metadata, "title", title.c_str(), 0);
  if (const int code = avio_open(&format->pb, unfinished.c_str(), AVIO_FLAG_WRITE); code < 0) {
    return failed(av_words(code));
  }
  AVDictionary* options = nullptr;
  av_dict_set(&options, "movflags", "+faststart", 0);
  const int code = avformat_write_header(format.get(), &options);
  av_dict_free(&options);
  if (code < 0) return failed(av_words(code));

  frame->format = codec->pix_fmt;
  frame->width = width;
  frame->height = height;
  frame->pts = 0;
  if (const int got = av_frame_get_buffer(frame.get(), 0); got < 0) return failed(av_words(got));

  scaler.reset(sws_getContext(width, height, AV_PIX_FMT_RGB24, width, height, codec->pix_fmt,
                              SWS_BICUBIC | SWS_ACCURATE_RND | SWS_BITEXACT | SWS_FULL_CHR_H_INP, nullptr, nullptr,
                              nullptr));
  if (!scaler) return failed("libswscale cannot convert this size");
  // The same matrix as the tags above name; the default would be BT.601. From full range RGB to limited range YUV.
  const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
  sws_setColorspaceDetails(scaler.get(), bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
  return {};
}

Result<void> MovieWriter::Impl::encode(const AVFrame* picture) {
  if (const int code = avcodec_send_frame(codec.get(), picture); code < 0) return failed(av_words(code));
  for (;;) {
    const int code = avcodec_receive_packet(codec.get(), packet.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return {};
    if (code < 0) return failed(av_words(code));
    packet->stream_index = stream->index;
    packet->duration = 1;
    av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
    if (const int written = av_interleaved_write_frame(format.get(), packet.get()); written < 0) {
      return failed(av_words(written));
    }
  }
}

MovieWriter::MovieWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MovieWriter::MovieWriter(MovieWriter&&) noexcept = default;
MovieWriter& MovieWriter::operator=(MovieWriter&&) noexcept = default;
MovieWriter::~MovieWriter() = default;

Result<MovieWriter> MovieWriter::create(const std::filesystem::path& file, int width, int height, double fps,
                                        const std::string& title) {
  if (width < 2 || height < 2 || width % 2 != 0 || height % 2 != 0) {
    return Error{"a movie needs an even width and height, not " + std::to_string(width) + "x" + std::to_string(height)};
  }
  if (!(fps > 0 && fps <= 1000)) return Error{"a movie needs more than 0 and at most 1000 frames per second"};
  av_log_set_level(AV_LOG_QUIET);  // errors come back as codes
  auto impl = std::make_unique<Impl>();
  impl->file = file;
  impl->unfinished = file.string() + ".tmp";
  if (auto done = impl->open(width, height, fps, title); !done) return done.error();
  return MovieWriter(std::move(impl));
}

Result<void> MovieWriter::add(const Image& image) {
  AVFrame* frame = impl_->frame.get();
  if (image.width != frame->width || image.height != frame->height) {
    return impl_->failed("a frame of another size than the movie's");
  }
  // The encoder may still hold the last frame.
  if (const int code = av_frame_make_writable(frame); code < 0) return impl_->failed(av_words(code));
  const std::uint8_t* rows[] = {image.rgb.data()};
  const int strides[] = {image.width * 3};
  sws_scale(impl_->scaler.get(), rows, strides, 0, image.height, frame->data, frame->linesize);
  if (auto done = impl_->encode(frame); !done) return done.error();
  ++frame->pts;
  return {};
}

Result<void> MovieWriter::finish() {
  if (auto done = impl_->encode(nullptr); !done) return done.error();
  if (const int code = av_write_trailer(impl_->format.get()); code < 0) return impl_->failed(av_words(code));
  if (const int code = avio_closep(&impl_->format->pb); code < 0) return impl_->failed(av_words(code));
  if (std::rename(impl_->unfinished.c_str(), impl_->file.c_str()) != 0) return impl_->failed(std::strerror(errno));
  impl_->finished = true;
  return {};
}

}  // namespace shaken::render
