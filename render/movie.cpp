// SPDX-License-Identifier: MIT
#include "render/movie.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavfilter/avfilter.h>
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

#include "base/files.h"
#include "render/notes.h"

namespace shaken::render {
namespace {

/// A kind of film.
struct Format {
  const char* ending;
  const char* container;  ///< of libavformat
  const char* encoder;    ///< of libavcodec
  AVPixelFormat pixels;
  std::array<std::array<const char*, 2>, 4> settings;  ///< of the encoder; unused ones are null
  double most_fps;
  const char* small_crf;  ///< in place of that among the settings; null: there is no such choice
};
constexpr Format kFormats[] = {
    {".mp4", "mp4", "libx264", AV_PIX_FMT_YUV420P, {{{"preset", "veryfast"}, {"crf", "20"}}}, 1000, "30"},
    {".webm",
     "webm",
     "libvpx-vp9",
     AV_PIX_FMT_YUV420P,
     {{{"crf", "30"}, {"b", "0"}, {"deadline", "realtime"}, {"cpu-used", "8"}}},
     1000,
     "42"},
    // Every frame whole: the encoder of libavcodec 59 compares frames by index, also where their palettes differ.
    {".gif", "gif", "gif", AV_PIX_FMT_PAL8, {{{"gifflags", "0"}}}, 50, nullptr},
};

const Format* format_of(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  const auto* found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                   [&](const Format& format) { return ending == format.ending; });
  return found == std::end(kFormats) ? nullptr : found;
}

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
  void operator()(AVFilterGraph* graph) const { avfilter_graph_free(&graph); }
};
template <class T>
using Av = std::unique_ptr<T, FreeAv>;

/// Chooses the 256 colours of each picture.
class Palettes {
 public:
  Result<void> open(int width, int height, AVRational time_base) {
    graph_.reset(avfilter_graph_alloc());
    graph_->nb_threads = 1;
    const std::string size = "video_size=" + std::to_string(width) + "x" + std::to_string(height);
    const std::string description = "buffer@in=" + size +
                                    ":pix_fmt=rgb24:pixel_aspect=1/1:time_base=" + std::to_string(time_base.num) + "/" +
                                    std::to_string(time_base.den) +
                                    ",split[a][b];[a]palettegen=stats_mode=single:reserve_transparent=0[p];"
                                    "[b][p]paletteuse=new=1:dither=bayer:bayer_scale=5,buffersink@out";
    AVFilterInOut *inputs = nullptr, *outputs = nullptr;
    int code = avfilter_graph_parse2(graph_.get(), description.c_str(), &inputs, &outputs);
    avfilter_inout_free(&inputs);
    avfilter_inout_free(&outputs);
    if (code >= 0) code = avfilter_graph_config(graph_.get(), nullptr);
    if (code < 0) return Error{"libavfilter: " + av_words(code)};
    in_ = avfilter_graph_get_filter(graph_.get(), "buffer@in");
    out_ = avfilter_graph_get_filter(graph_.get(), "buffersink@out");
    if (!in_ || !out_) return Error{"libavfilter has lost a filter"};
    return {};
  }
  /// Null: the end. The picture stays the caller's.
  int put(AVFrame* picture) { return av_buffersrc_add_frame_flags(in_, picture, AV_BUFFERSRC_FLAG_KEEP_REF); }
  int take(AVFrame* picture) { return av_buffersink_get_frame(out_, picture); }

 private:
  Av<AVFilterGraph> graph_;
  AVFilterContext *in_ = nullptr, *out_ = nullptr;  // owned by the graph
};

}  // namespace

struct MovieWriter::Impl {
  std::filesystem::path file, unfinished;
  std::string address() const { return "file:" + unfinished.string(); }  ///< a name alone may be taken for a protocol
  Av<AVFormatContext> format;
  Av<AVCodecContext> codec;
  Av<AVFrame> frame;  // as the encoder takes it, or as its palette is chosen from
  Av<AVFrame> reduced;
  Av<AVPacket> packet;
  Av<SwsContext> scaler;
  std::unique_ptr<Palettes> palettes;  // of a GIF
  Notes comment;                       // of a GIF: the other formats have taken them when they were opened
  AVStream* stream = nullptr;          // owned by format
  bool finished = false;

  ~Impl() {
    if (finished) return;
    format.reset();
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
  }

  Error failed(const std::string& why) const { return Error{"cannot write " + file.string() + ": " + why}; }

  Result<void> open(const Format& kind, int width, int height, double fps, const std::string& title, const Notes& notes,
                    bool small);
  Result<void> encode(const AVFrame* picture);
  /// Encodes the pictures whose palettes are chosen.
  Result<void> encode_reduced();
};

Result<void> MovieWriter::Impl::open(const Format& kind, int width, int height, double fps, const std::string& title,
                                     const Notes& notes, bool small) {
  AVFormatContext* made = nullptr;
  if (const int code = avformat_alloc_output_context2(&made, nullptr, kind.container, address().c_str()); code < 0) {
    return failed(av_words(code));
  }
  format.reset(made);
  format->flags |= AVFMT_FLAG_BITEXACT;
  const AVCodec* encoder = avcodec_find_encoder_by_name(kind.encoder);
  if (!encoder) return failed(std::string("this libavcodec has no encoder ") + kind.encoder);
  stream = avformat_new_stream(format.get(), nullptr);
  codec.reset(avcodec_alloc_context3(encoder));
  frame.reset(av_frame_alloc());
  reduced.reset(av_frame_alloc());
  packet.reset(av_packet_alloc());
  if (!stream || !codec || !frame || !reduced || !packet) return failed("no memory");

  const AVRational rate = av_d2q(fps, 1001000);
  const bool has_palette = kind.pixels == AV_PIX_FMT_PAL8;
  codec->width = width;
  codec->height = height;
  codec->pix_fmt = kind.pixels;
  codec->time_base = av_inv_q(rate);
  codec->framerate = rate;
  codec->gop_size = 60;
  codec->thread_count = 1;
  if (!has_palette) {
    codec->color_primaries = AVCOL_PRI_BT709;
    codec->color_trc = AVCOL_TRC_BT709;
    codec->colorspace = AVCOL_SPC_BT709;
    codec->color_range = AVCOL_RANGE_MPEG;
  }
  if ((format->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  for (const auto& [key, value] : kind.settings) {
    if (key != nullptr) av_opt_set(codec.get(), key, value, AV_OPT_SEARCH_CHILDREN);
  }
  if (small && kind.small_crf != nullptr) av_opt_set(codec.get(), "crf", kind.small_crf, AV_OPT_SEARCH_CHILDREN);
  if (const int code = avcodec_open2(codec.get(), encoder, nullptr); code < 0) return failed(av_words(code));

  stream->time_base = codec->time_base;
  stream->avg_frame_rate = rate;
  avcodec_parameters_from_context(stream->codecpar, codec.get());
  if (!title.empty()) av_dict_set(&format->metadata, "title", title.c_str(), 0);
  if (const std::string words = notes_text(notes); !words.empty())
    av_dict_set(&format->metadata, "comment", words.c_str(), 0);
  if (const int code = avio_open(&format->pb, address().c_str(), AVIO_FLAG_WRITE); code < 0) {
    return failed(av_words(code));
  }
  AVDictionary* options = nullptr;
  if (std::string_view(kind.container) == "mp4") av_dict_set(&options, "movflags", "+faststart", 0);
  const int code = avformat_write_header(format.get(), &options);
  av_dict_free(&options);
  if (code < 0) return failed(av_words(code));

  frame->format = has_palette ? AV_PIX_FMT_RGB24 : kind.pixels;
  frame->width = width;
  frame->height = height;
  frame->pts = 0;
  if (const int got = av_frame_get_buffer(frame.get(), 0); got < 0) return failed(av_words(got));
  if (has_palette) {
    palettes = std::make_unique<Palettes>();
    if (auto done = palettes->open(width, height, codec->time_base); !done) return failed(done.error().message);
    return {};
  }

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

Result<void> MovieWriter::Impl::encode_reduced() {
  for (;;) {
    const int code = palettes->take(reduced.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return {};
    if (code < 0) return failed(av_words(code));
    auto done = encode(reduced.get());
    av_frame_unref(reduced.get());
    if (!done) return done.error();
  }
}

std::string movie_endings() {
  std::string all;
  const std::size_t n = std::size(kFormats);
  for (std::size_t i = 0; i < n; ++i)
    all += (i == 0 ? "" : i + 1 == n ? " or " : ", ") + std::string(kFormats[i].ending);
  return all;
}

bool is_movie_name(const std::filesystem::path& file) { return format_of(file) != nullptr; }

Result<void> check_movie(const std::filesystem::path& file, int width, int height, double fps) {
  const Format* kind = format_of(file);
  if (kind != nullptr && !(fps > 0 && fps <= kind->most_fps)) {
    return Error{std::string("a movie as ") + kind->ending + " needs more than 0 and at most " +
                 std::to_string(static_cast<int>(kind->most_fps)) + " frames per second"};
  }
  const bool is_odd = width % 2 != 0 || height % 2 != 0;
  if (width >= 2 && height >= 2 && (!is_odd || kind == nullptr || kind->pixels == AV_PIX_FMT_PAL8)) return {};
  return Error{"a movie needs an even width and height, not " + std::to_string(width) + "x" + std::to_string(height)};
}

MovieWriter::MovieWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MovieWriter::MovieWriter(MovieWriter&&) noexcept = default;
MovieWriter& MovieWriter::operator=(MovieWriter&&) noexcept = default;
MovieWriter::~MovieWriter() = default;

Result<MovieWriter> MovieWriter::create(const std::filesystem::path& file, int width, int height, double fps,
                                        const std::string& title, const Notes& notes, bool small) {
  const Format* kind = format_of(file);
  if (kind == nullptr) return Error{"a film is written as " + movie_endings() + ", not as " + file.string()};
  if (auto done = check_movie(file, width, height, fps); !done) return done.error();
  av_log_set_level(AV_LOG_QUIET);  // errors come back as codes
  auto impl = std::make_unique<Impl>();
  impl->file = file;
  impl->unfinished = temporary_for(file);
  impl->comment = notes;
  if (auto done = impl->open(*kind, width, height, fps, title, notes, small); !done) return done.error();
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
  if (impl_->palettes) {
    for (int y = 0; y < image.height; ++y) {
      std::memcpy(frame->data[0] + static_cast<std::ptrdiff_t>(y) * frame->linesize[0], image.pixel(0, y),
                  image.row_bytes());
    }
    if (const int code = impl_->palettes->put(frame); code < 0) return impl_->failed(av_words(code));
    ++frame->pts;
    return impl_->encode_reduced();
  }
  sws_scale(impl_->scaler.get(), rows, strides, 0, image.height, frame->data, frame->linesize);
  if (auto done = impl_->encode(frame); !done) return done.error();
  ++frame->pts;
  return {};
}

Result<void> MovieWriter::finish() {
  if (impl_->palettes) {
    if (const int code = impl_->palettes->put(nullptr); code < 0) return impl_->failed(av_words(code));
    if (auto done = impl_->encode_reduced(); !done) return done.error();
  }
  if (auto done = impl_->encode(nullptr); !done) return done.error();
  if (const int code = av_write_trailer(impl_->format.get()); code < 0) return impl_->failed(av_words(code));
  if (const int code = avio_closep(&impl_->format->pb); code < 0) return impl_->failed(av_words(code));
  if (impl_->palettes) {
    if (auto done = add_notes_to_gif(impl_->unfinished, impl_->comment); !done)
      return impl_->failed(done.error().message);
  }
  if (std::rename(impl_->unfinished.c_str(), impl_->file.c_str()) != 0) return impl_->failed(std::strerror(errno));
  impl_->finished = true;
  return {};
}

}  // namespace shaken::render
