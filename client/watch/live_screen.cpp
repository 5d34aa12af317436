// SPDX-License-Identifier: MIT
#include "client/watch/live_screen.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace shaken::client {
namespace {

constexpr std::chrono::milliseconds kShortestPause{100};
constexpr std::size_t kMostBytesPerSecond = 1'500'000;
constexpr std::size_t kMostRemoteBytesPerSecond = 150'000;
/// The bytes of one key follow each other faster than this.
constexpr std::chrono::milliseconds kWithinAKey{50};
/// A terminal that has not answered by then is not waited for.
constexpr std::chrono::milliseconds kWithinAnAnswer{1000};

std::vector<DefectMark> marks_of(const LiveJobs& jobs, const std::string& id) {
  std::vector<DefectMark> marks;
  for (const LiveJob& job : jobs.jobs()) {
    if (job.id != id || !job.defects) continue;
    const defects_t& message = *job.defects;
    for (std::size_t i = 0; i < message.charge.size(); ++i) {
      if (!std::isfinite(message.x_mm[i]) || !std::isfinite(message.y_mm[i])) continue;
      marks.push_back({message.x_mm[i], message.y_mm[i], message.charge[i] > 0});
    }
  }
  return marks;
}

}  // namespace

std::chrono::milliseconds pause_after(std::size_t bytes, bool is_remote) {
  const std::size_t rate = is_remote ? kMostRemoteBytesPerSecond : kMostBytesPerSecond;
  return std::max(kShortestPause, std::chrono::milliseconds(1000 * bytes / rate));
}

LiveScreen::LiveScreen(const ScreenSettings& settings) : settings_(settings), writer_(settings.depth) { ask(); }

LiveScreen::~LiveScreen() {
  session_.write(image_.remove());
  await_answers();
}

void LiveScreen::ask() {
  const TerminalSize size = terminal_size(STDOUT_FILENO).value_or(TerminalSize{});
  const bool knows_pixels = size.width > 0;
  const bool has_question = settings_.graphics == Graphics::kAuto
                                ? answers_.n_complete == 0 || (answers_.best() != Graphics::kBlocks && !knows_pixels)
                                : settings_.graphics != Graphics::kBlocks && !knows_pixels;
  if (!has_question || !session_.has_keys() || !session_.write(terminal_questions())) return;
  ++n_asked_;
  asked_at_ = Clock::now();
  asked_size_ = size;
}

void LiveScreen::take_answers() {
  for (const std::string& answer : keys_.take_answers()) answers_.note(answer);
}

/// So that what the terminal still has to say does not come to the shell.
void LiveScreen::await_answers() {
  while (answers_.n_complete < n_asked_ && session_.has_keys()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(asked_at_ + kWithinAnAnswer - Clock::now());
    pollfd readable{STDIN_FILENO, POLLIN, 0};
    if (left.count() <= 0 || poll(&readable, 1, static_cast<int>(left.count())) <= 0) return;
    const std::string bytes = session_.read();
    if (bytes.empty()) return;
    keys_.add(bytes);
    take_answers();
  }
}

Graphics LiveScreen::graphics() const {
  return settings_.graphics == Graphics::kAuto ? answers_.best() : settings_.graphics;
}

std::optional<PixelSize> LiveScreen::cell(TerminalSize size) const {
  if (graphics() == Graphics::kBlocks) return std::nullopt;
  const TerminalSize reported = terminal_size(STDOUT_FILENO).value_or(TerminalSize{});
  if (const auto cell = cell_size({reported.width, reported.height}, reported.columns, reported.lines)) return cell;
  // That of another size of the window would make images too large for their place.
  const bool is_present = answers_.n_complete == n_asked_ && asked_size_.columns == size.columns &&
                          asked_size_.lines == size.lines && answers_.window;
  return is_present ? cell_size(*answers_.window, size.columns, size.lines) : std::nullopt;
}

std::string LiveScreen::image_bytes(const WatchContent& content, const CellGrid& grid) {
  const std::optional<Area> area = image_area(content, grid.columns(), grid.lines());
  if (!area) {
    if (image_.is_shown()) writer_.forget();
    return image_.remove();
  }
  if (writer_.draws_whole(grid)) image_.forget();
  const RodImage image =
      draw_rod_image(*content.rods, steering_.shows_defects ? defects_ : std::vector<DefectMark>(), steering_.view,
                     steering_.shown_colouring(), image_size(*content.cell, *area), content.cell->height);
  return image_.update(image, *area, graphics());
}

std::chrono::milliseconds LiveScreen::draw(const LiveJobs& jobs, const std::string& title, const std::string& note,
                                           TerminalSize size) {
  if (!steering_.paused) {
    steering_.job = job_to_show(steering_.job, jobs);
    rods_.select(steering_.job);
    shown_ = rods_.newest();
    defects_ = marks_of(jobs, steering_.job);
  }
  if (shown_) steering_.automatic = automatic_colouring(shown_->order, steering_.automatic);
  if (std::exchange(steering_.redraw, false)) writer_.forget();
  const std::optional<PixelSize> image_cell = cell(size);
  const bool is_wanted = settings_.graphics == Graphics::kSixel || settings_.graphics == Graphics::kKitty;
  const bool lacks_pixels = is_wanted && !image_cell && Clock::now() >= asked_at_ + kWithinAnAnswer;
  const WatchContent content{.jobs = jobs,
                             .steering = steering_,
                             .rods = shown_.get(),
                             .defects = defects_,
                             .title = title,
                             .note = lacks_pixels ? "no image: size in pixels unknown" : note,
                             .depth = settings_.depth,
                             .cell = image_cell};
  steering_.has_images = content.cell.has_value();
  const CellGrid grid = watch_cells(content, size.columns, size.lines);
  const std::string image = image_bytes(content, grid);
  const std::string bytes = writer_.update(grid, image);
  if (!session_.write(bytes)) writer_.forget();
  return pause_after(bytes.size(), settings_.is_remote);
}

bool LiveScreen::wait(int bus_descriptor, std::chrono::milliseconds time, const LiveJobs& jobs) {
  if (keys_.is_waiting()) time = std::min(time, kWithinAKey);
  std::array<pollfd, 3> descriptors{{{session_.has_keys() ? STDIN_FILENO : -1, POLLIN, 0},
                                     {session_.resize_descriptor(), POLLIN, 0},
                                     {bus_descriptor, POLLIN, 0}}};
  if (poll(descriptors.data(), descriptors.size(), static_cast<int>(std::max<std::int64_t>(0, time.count()))) < 0) {
    return false;  // a signal; the caller knows which
  }
  const bool is_resized = descriptors[1].revents != 0;
  if (is_resized) {
    session_.take_resizes();
    ask();  // characters may have another size, too
  }
  const Clock::time_point now = Clock::now();
  std::vector<Key> keys;
  if (descriptors[0].revents != 0) {
    keys = keys_.add(session_.read());
    typed_at_ = now;
  } else if (now - typed_at_ >= (keys_.is_in_answer() ? kWithinAnAnswer : kWithinAKey)) {
    keys = keys_.flush();
  }
  take_answers();
  obey(keys, jobs);
  return is_resized || !keys.empty();
}

void LiveScreen::obey(const std::vector<Key>& keys, const LiveJobs& jobs) {
  const std::string before = steering_.job;
  const Vec2 period = shown_ ? shown_->cell.period() : Vec2(1, 1);
  for (const Key& key : keys) steering_ = steered(steering_, key, choices(jobs), period);
  // What is held is the picture of the run that was shown.
  if (steering_.job != before) steering_.paused = false;
  if (std::exchange(steering_.suspend, false)) {
    session_.write(image_.remove());
    session_.suspend();
    writer_.forget();
    n_asked_ = answers_.n_complete;  // what was still to come has gone to the shell
    ask();
  }
}

}  // namespace shaken::client
