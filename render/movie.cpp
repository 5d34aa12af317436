#include "render/movie.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <iterator>
#include <sstream>
#include <utility>
#include <vector>

#include "base/descriptor.h"
#include "base/files.h"
#include "base/process.h"
#include "base/text.h"
#include "render/notes.h"

namespace shaken::render {
namespace {

/// A kind of film.
struct Format {
  const char* ending;
  const char* options;  ///< of ffmpeg
  int most_fps;
  const char* crf;  ///< null: there is no such choice
  const char* small_crf;
  bool is_gif() const { return crf == nullptr; }
};
// From full range RGB to limited range YUV by BT.709 (the default would be BT.601), with the tags that say so.
#define SHAKEN_BT709                                                                                                  \
  " -vf scale=out_color_matrix=bt709:out_range=tv:flags=bicubic+accurate_rnd+full_chroma_inp+bitexact,format=yuv420p" \
  " -colorspace bt709 -color_primaries bt709 -color_trc bt709 -color_range tv"
constexpr Format kFormats[] = {
    {".mp4", "-f mp4 -c:v libx264 -preset veryfast -movflags +faststart" SHAKEN_BT709, 1000, "20", "30"},
    {".webm", "-f webm -c:v libvpx-vp9 -b:v 0 -deadline realtime -cpu-used 8" SHAKEN_BT709, 1000, "30", "42"},
    // Every frame whole: the encoder of ffmpeg 5.1 compares frames by index, also where their palettes differ.
    {".gif",
     "-f gif -gifflags 0 -filter_complex split[a][b];[a]palettegen=stats_mode=single:reserve_transparent=0[p];"
     "[b][p]paletteuse=new=1:dither=bayer:bayer_scale=5",
     50, nullptr, nullptr},
};
#undef SHAKEN_BT709

const Format* format_of(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  const auto* found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                   [&](const Format& format) { return ending == format.ending; });
  return found == std::end(kFormats) ? nullptr : found;
}

}  // namespace

struct MovieWriter::Impl {
  std::filesystem::path file;
  UnfinishedFile unfinished;
  int width = 0, height = 0;
  Notes gif_comment;  ///< ffmpeg writes those of other formats
  Descriptor frames;  ///< ffmpeg reads them; a socket, for writing to a pipe that nobody reads would end this program
  Descriptor messages;
  pid_t ffmpeg = 0;

  explicit Impl(const std::filesystem::path& movie) : file(movie), unfinished(movie) {}
  ~Impl() {
    if (ffmpeg > 0) {
      kill(ffmpeg, SIGKILL);
      wait_for_child(ffmpeg);
    }
  }

  Error failed(const std::string& why) const { return Error{"cannot write " + file.string() + ": " + why}; }

  Result<void> start(const std::vector<std::string>& command) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return failed(std::strerror(errno));
    frames = Descriptor(ends[0]);
    const Descriptor theirs(ends[1]);
    messages = Descriptor(memfd_create("ffmpeg", MFD_CLOEXEC));
    const auto child = start_child({.command = command,
                                    .input = theirs.value(),
                                    .output = messages.value(),
                                    .own_group = true,
                                    .ends_with_us = true});
    if (!child) return failed(child.error().message + "; it encodes films: `apt install ffmpeg`");
    ffmpeg = *child;
    return {};
  }
  /// Waits for the end of the film, or of ffmpeg without one.
  Result<void> end() {
    if (ffmpeg == 0) return failed("ffmpeg has ended before the film");
    frames = Descriptor();
    const ProcessEnd how = wait_for_child(std::exchange(ffmpeg, 0));
    if (how.is_success()) return {};
    const auto said = read_part("/proc/self/fd/" + std::to_string(messages.value()), 0, 1000);
    std::string words = said ? *said : said.error().message;
    while (words.ends_with('\n')) words.pop_back();
    return failed("ffmpeg " + how.text() + (words.empty() ? "" : ": " + printable(words, Lines::kMany)));
  }
};

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
    return Error{
        fmt::format("a movie as {} needs more than 0 and at most {} frames per second", kind->ending, kind->most_fps)};
  }
  const bool is_odd = width % 2 != 0 || height % 2 != 0;
  if (width >= 2 && height >= 2 && (!is_odd || kind == nullptr || kind->is_gif())) return {};
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
  SHAKEN_TRY(check_movie(file, width, height, fps));
  auto impl = std::make_unique<Impl>(file);
  impl->width = width;
  impl->height = height;
  if (!Descriptor(open(impl->unfinished.path().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)))
    return impl->failed(std::strerror(errno));
  // -xerror: else a disk that is full when the index is written would be no failure
  std::istringstream words(fmt::format(
      "ffmpeg -v error -xerror -nostdin -y -f rawvideo -pix_fmt rgb24 -s {}x{} -framerate {:.17g} -i - -g 60 "
      "-threads 1 -fps_mode passthrough -fflags +bitexact -flags:v +bitexact {}",
      width, height, fps, kind->options));
  std::vector<std::string> command{std::istream_iterator<std::string>(words), {}};
  if (kind->is_gif()) {
    impl->gif_comment = notes;
  } else {
    command.insert(command.end(), {"-crf", small ? kind->small_crf : kind->crf, "-metadata", "title=" + title,
                                   "-metadata", "comment=" + notes_text(notes)});
  }
  command.push_back("file:" + impl->unfinished.path().string());  // a name alone may be taken for a protocol
  SHAKEN_TRY(impl->start(command));
  return MovieWriter(std::move(impl));
}

Result<void> MovieWriter::add(const Image& image) {
  if (image.width != impl_->width || image.height != impl_->height) {
    return impl_->failed("a frame of another size than the movie's");
  }
  for (std::size_t sent = 0; sent < image.rgb.size();) {
    const ssize_t n = send(impl_->frames.value(), &image.rgb[sent], image.rgb.size() - sent, MSG_NOSIGNAL);
    if (n > 0) sent += static_cast<std::size_t>(n);
    if (n >= 0 || errno == EINTR) continue;
    if (auto done = impl_->end(); !done) return done;
    return impl_->end();  // it has ended, but not for a failure
  }
  return {};
}

Result<void> MovieWriter::finish() {
  if (auto done = impl_->end(); !done) return done;
  if (auto done = add_notes_to_gif(impl_->unfinished.path(), impl_->gif_comment); !done)
    return impl_->failed(done.error().message);
  return impl_->unfinished.replace(Lasting::kNo);
}

}  // namespace shaken::render
