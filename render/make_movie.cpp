#include "render/make_movie.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "render/inset.h"
#include "render/legend.h"
#include "render/movie.h"
#include "render/painter.h"
#include "render/png.h"

namespace shaken::render {
namespace {

bool is_folder_name(const std::string& out) { return out.ends_with('/'); }

struct Drawn {
  Result<Image> image;
  Notes texts;
};

/// Threads that draw, each with a painter of its own. What is handed in comes out in the same order.
class Workshop {
 public:
  Workshop(int n_threads, const PictureStyle& style) : style_(style) {
    for (int i = 0; i < n_threads; ++i) threads_.emplace_back([this] { work(); });
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;
  ~Workshop() {
    {
      const std::lock_guard lock(mutex_);
      closing_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  std::size_t n_inside() const { return handed_in_ - taken_; }
  void put(RodPicture picture) {
    {
      const std::lock_guard lock(mutex_);
      waiting_.emplace_back(handed_in_++, std::move(picture));
    }
    changed_.notify_all();
  }
  /// The next picture, when it is drawn.
  Drawn take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return drawn_.contains(taken_); });
    auto node = drawn_.extract(taken_++);
    return std::move(node.mapped());
  }

 private:
  void work() {
    // Mesa sets itself up with the first context: one at a time.
    static std::mutex creating;
    std::optional<Result<Painter>> painter;
    {
      const std::lock_guard lock(creating);
      painter = Painter::create();
    }
    for (;;) {
      std::pair<std::size_t, RodPicture> next;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return closing_ || !waiting_.empty(); });
        if (closing_) return;
        next = std::move(waiting_.front());
        waiting_.pop_front();
      }
      Drawn drawn{*painter ? (*painter)->paint(next.second, style_) : Result<Image>(painter->error()),
                  picture_texts(next.second.frame, next.second.captions)};
      {
        const std::lock_guard lock(mutex_);
        drawn_.emplace(next.first, std::move(drawn));
      }
      changed_.notify_all();
    }
  }

  const PictureStyle style_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::pair<std::size_t, RodPicture>> waiting_;
  std::map<std::size_t, Drawn> drawn_;
  std::size_t handed_in_ = 0, taken_ = 0;  // of the one thread that puts and takes
  bool closing_ = false;
  std::vector<std::thread> threads_;
};

/// Where the frames go.
class Output {
 public:
  static Result<Output> open(const std::string& out, const PictureStyle& style, const MovieOptions& options) {
    Output output;
    output.folder_ = options.keep_frames;
    output.is_raw_ = out == "-";
    if (is_folder_name(out)) {
      output.folder_ = out;
    } else if (!output.is_raw_) {
      Result<MovieWriter> movie =
          MovieWriter::create(out, style.width, style.height, style.fps, options.title, options.notes, style.small);
      if (!movie) return movie.error();
      output.movie_.emplace(std::move(*movie));
    }
    if (output.folder_) {
      std::error_code code;
      std::filesystem::create_directories(*output.folder_, code);
      if (code) return Error{"cannot make the folder " + output.folder_->string() + ": " + code.message()};
    }
    return output;
  }

  Result<void> add(std::size_t i, const Image& image, const Notes& texts) {
    if (folder_) {
      if (auto done = write_png(*folder_ / fmt::format("frame_{:06d}.png", i), image, texts); !done)
        return done.error();
    }
    if (is_raw_ && std::fwrite(image.rgb.data(), 1, image.rgb.size(), stdout) != image.rgb.size()) {
      return Error{std::string("cannot write to stdout: ") + std::strerror(errno)};
    }
    return movie_ ? movie_->add(image) : Result<void>();
  }
  Result<void> finish() {
    if (is_raw_ && std::fflush(stdout) != 0)
      return Error{std::string("cannot write to stdout: ") + std::strerror(errno)};
    return movie_ ? movie_->finish() : Result<void>();
  }

 private:
  std::optional<MovieWriter> movie_;
  std::optional<std::filesystem::path> folder_;
  bool is_raw_ = false;
};

constexpr std::size_t kLooks = 16;

void reach(FilmAxes& axes, const RodPicture& picture, const PictureStyle& style) {
  axes.share = std::max(axes.share, highest_bar(picture, style));
  if (style.inset == Inset::kAngles) {
    const Curve curve = angle_curve(picture);
    axes.density = std::max(axes.density, *std::max_element(curve.y.begin(), curve.y.end()));
  }
}

}  // namespace

Result<void> check_movie_name(const std::string& out) {
  if (out == "-" || is_folder_name(out) || is_movie_name(out)) return {};
  return Error{"a film is written as " + movie_endings() +
               ", to a folder of frames (FOLDER/), or raw to stdout (-); '" + out + "' is none of these"};
}

Result<void> make_movie(const std::string& out, const PictureStyle& style, const MovieOptions& options,
                        std::size_t n_frames, const std::function<Result<RodPicture>(std::size_t)>& picture,
                        const std::function<bool(std::size_t)>& on_frame) {
  if (n_frames == 0) return Error{"there are no frames to make " + out + " of"};
  SHAKEN_TRY(check_movie_name(out));
  Output output = SHAKEN_TRY(Output::open(out, style, options));
  const int n_threads = std::max(1, options.n_threads);
  Workshop workshop(n_threads, style);
  std::size_t written = 0;
  const auto write_next = [&]() -> Result<void> {
    const Drawn drawn = workshop.take();
    if (!drawn.image) return drawn.image.error();
    SHAKEN_TRY(output.add(written, *drawn.image, drawn.texts));
    ++written;
    if (on_frame && !on_frame(written - 1)) return Error{"stopped after " + std::to_string(written) + " frames"};
    return {};
  };
  for (std::size_t i = 0; i < n_frames; ++i) {
    // One picture waits for each thread, so that none idles.
    while (workshop.n_inside() >= 2 * static_cast<std::size_t>(n_threads)) {
      SHAKEN_TRY(write_next());
    }
    workshop.put(SHAKEN_TRY(picture(i)));
  }
  while (written < n_frames) {
    SHAKEN_TRY(write_next());
  }
  return output.finish();
}

Result<FilmAxes> film_axes(std::size_t n_frames, const std::function<Result<RodPicture>(std::size_t)>& picture,
                           const PictureStyle& style) {
  FilmAxes axes;
  if (!style.legend && style.inset != Inset::kAngles) return axes;
  const std::size_t first = n_frames / 2, n_later = n_frames - first, n_looks = std::min(kLooks, n_later);
  for (std::size_t k = 0; k < n_looks; ++k) {
    const RodPicture rods = SHAKEN_TRY(picture(first + k * n_later / n_looks));
    reach(axes, rods, style);
    for (const RodPicture& beside : rods.beside) reach(axes, beside, style);
  }
  return axes;
}

}  // namespace shaken::render
