#include "client/watch/screen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include "base/clock.h"
#include "base/text.h"
#include "client/live/target.h"
#include "client/watch/director_cells.h"
#include "client/watch/overview.h"
#include "client/watch/rod_samples.h"

namespace shaken::client {
namespace {

// Beside each other.
constexpr int kFewestColumns = 60;
constexpr int kFewestLines = 16;
constexpr int kNumberColumns = 32;  // at least
// Under each other.
constexpr int kFewestStackedColumns = 40;
constexpr int kFewestStackedLines = 28;
constexpr int kNumberLines = 9;
constexpr int kMostNumberLines = 20;

constexpr int kFrameLines = 3;  // title, legend, status

/// Half-cells along the side of the square that fits into the picture.
int side_of(const WatchLayout& layout) { return std::min(layout.picture.columns, 2 * layout.picture.lines); }

std::optional<WatchLayout> beside(int columns, int lines) {
  if (columns < kFewestColumns || lines < kFewestLines) return std::nullopt;
  const int height = lines - kFrameLines;
  const int width = std::min(2 * height, columns - 1 - kNumberColumns);
  return WatchLayout{.picture = {0, 1, width, height},
                     .legend = {0, lines - 2, width, 1},
                     .numbers = {width + 1, 1, columns - width - 1, lines - 2}};
}

std::optional<WatchLayout> stacked(int columns, int lines) {
  if (columns < kFewestStackedColumns || lines < kFewestStackedLines) return std::nullopt;
  const int free = lines - kFrameLines;
  const int below = std::clamp(free - (columns + 1) / 2, kNumberLines, kMostNumberLines);
  return WatchLayout{.picture = {0, 1, columns, free - below},
                     .legend = {0, 1 + free - below, columns, 1},
                     .numbers = {0, 2 + free - below, columns, below}};
}

/// The last line: as many of the keys as there is room for, of which "? keys" has the others, and then `note`.
std::string status_line(const std::string& note, int columns) {
  constexpr std::string_view kAllKeys = "? keys";
  constexpr std::size_t kShortestNote = 12;
  const auto width = static_cast<std::size_t>(columns);
  std::string line;
  for (const std::string_view key : {"q leave", "Tab run", "space hold", "+/- zoom", "c colours", "o numbers"}) {
    if (line.size() + key.size() + 2 + kAllKeys.size() > width) break;
    line.append(key).append("  ");
  }
  line += kAllKeys;
  return line.size() + 2 + kShortestNote <= width ? line + "  " + note : line;
}

/// Paints text for a screen; nothing is written to its streams.
Console painter(const WatchContent& content, int columns, int lines) {
  return {.out = std::cout,
          .err = std::cerr,
          .colour = content.depth != ColourDepth::kNone,
          .width = columns,
          .height = lines};
}

const LiveJob* job_in(const LiveJobs& jobs, const std::string& id) {
  const auto place = std::find_if(jobs.jobs().begin(), jobs.jobs().end(), [&](const LiveJob& j) { return j.id == id; });
  return place == jobs.jobs().end() ? nullptr : &*place;
}

RodStyle rod_style(const WatchContent& content) {
  const bool in_colour = content.depth != ColourDepth::kNone;
  Grain grain = content.steering.grain;
  if (grain == Grain::kAuto) grain = in_colour ? Grain::kBlocks : Grain::kBraille;
  return {.colouring = content.steering.shown_colouring(),
          .grain = grain,
          .in_colour = in_colour,
          .mixes = content.depth == ColourDepth::k256 || content.depth == ColourDepth::kTrue,
          .shows_defects = content.steering.shows_defects};
}

/// "├────┤ 5 mm", with a bar of at most so many columns.
std::string scale_bar(double columns_per_mm, double columns) {
  const double length = round_length(columns / columns_per_mm);
  const int width = std::max(2, static_cast<int>(std::lround(length * columns_per_mm)));
  std::string bar = "├";
  for (int i = 2; i < width; ++i) bar += "─";
  return bar + fmt::format("┤ {} mm", number_text(length));
}

int put_tones(CellGrid& grid, int column, int line, std::initializer_list<Tone> tones) {
  for (const Tone tone : tones) {
    if (column >= grid.columns()) break;
    grid.at(column++, line) = {.back = ink_of(tone)};
  }
  return column;
}

/// Whether the director is drawn in place of rods, which would be too thin to be told apart.
bool has_director(const WatchContent& content, const Area& picture) {
  return draws_director(*content.rods, content.steering.view, content.steering.shown_colouring(), picture);
}

double columns_per_mm(const WatchContent& content, const Area& picture) {
  return samples_per_mm(*content.rods, content.steering.view, 2 * picture.columns, 4 * picture.lines) / 2;
}

void put_legend(const WatchContent& content, const Area& area, const Area& picture, CellGrid& grid) {
  const int end = area.column + area.columns;
  int column = area.column;
  const auto put = [&](const std::string& text) { column = grid.put(column, area.line, text, end - column); };
  const auto put_colours = [&](std::initializer_list<Tone> tones) {
    if (column + static_cast<int>(tones.size()) <= end) column = put_tones(grid, column, area.line, tones);
  };
  const bool is_director = has_director(content, picture);
  put(scale_bar(columns_per_mm(content, picture), picture.columns / (is_director ? 5.0 : 3.0)) + " ");
  const bool has_strokes = rod_style(content).grain == Grain::kBraille;
  const bool in_colour = content.depth != ColourDepth::kNone;
  if (is_director) put(!has_strokes ? "director, S: " : in_colour ? "director ─╱│╲ " : "director ─╱│╲  · low S");
  if (!in_colour) return;
  constexpr double kStep = std::numbers::pi / 6;
  switch (content.steering.shown_colouring()) {
    case Colouring::kAuto:
    case Colouring::kLayers:
      put("−15° ");
      put_colours({layer_tone(-0.3), layer_tone(-0.13), layer_tone(0), layer_tone(0.13), layer_tone(0.3)});
      put(" +15°");
      if (constexpr std::string_view kOf = " to the director"; column + std::ssize(kOf) <= end) put(std::string(kOf));
      break;
    case Colouring::kWheel:
      put("0° ");
      put_colours({wheel_tone(0), wheel_tone(kStep), wheel_tone(2 * kStep), wheel_tone(3 * kStep),
                   wheel_tone(4 * kStep), wheel_tone(5 * kStep)});
      put(" 180°");
      break;
    case Colouring::kTilt:
      put(fmt::format("tail up −{} ", kFullTilt));
      put_colours({tilt_tone(-kFullTilt), tilt_tone(-kFullTilt / 2), tilt_tone(0), tilt_tone(kFullTilt / 2),
                   tilt_tone(kFullTilt)});
      put(fmt::format(" {} head up", kFullTilt));
      break;
    case Colouring::kSpecies:
      for (std::size_t i = 0; i < content.rods->cell.n_species(); ++i) {
        put_colours({species_tone(i), species_tone(i)});
        put(fmt::format(" rods{} ", i == 0 ? "" : fmt::format("_{}", i + 1)));
      }
      break;
  }
}

/// What is known of one run, a few words a line.
std::vector<std::string> number_lines(const LiveJob& job, const Console& console) {
  std::vector<std::string> lines;
  lines.push_back(console.painted(Colour::kBold, short_id(job.id)) + "  " + job.label);
  lines.push_back(
      fmt::format("{} {:.1f} %", console.painted(Colour::kBlue, bar_text(job.fraction(), 16)), 100 * job.fraction()));
  lines.push_back(fmt::format("{} of {}", duration_text(job.sim_time), duration_text(job.sim_time_total)));
  if (job.draws_film) {
    lines.push_back(console.painted(Colour::kYellow, film_text(job)));
    lines.push_back(console.painted(Colour::kYellow, bar_text(job.drawn, 16)) + " the run is done");
  } else if (job.is_running()) {
    lines.push_back(fmt::format("ETA {} ({})", duration_text(job.eta), clock_text(job.eta, utime_now())));
    lines.push_back(fmt::format("{:.3g} sim-s/s", job.sim_rate));
  } else {
    lines.push_back(job.state + (job.reason.empty() ? "" : ": " + job.reason));
  }
  if (job.result) {
    lines.push_back(fmt::format("mean S {}{:.3f}", mark_of(job.result->steadiness), job.result->value));
    if (job.result->steadiness != Steadiness::kSteady) lines.push_back(word_of(job.result->steadiness));
  } else if (job.order) {  // spheres have none
    lines.push_back(fmt::format("S {}  mean {:.3f}", console.painted(Colour::kGreen, fmt::format("{:.3f}", *job.order)),
                                job.order_mean));
  }
  std::string line = fmt::format("N {}", job.n_rods);
  if (job.n_plus) line += fmt::format("  defects +{} −{}", *job.n_plus, *job.n_minus);
  lines.push_back(line);
  lines.push_back(fmt::format("overlap {:.2g} mm", job.max_overlap));
  if (job.observables) {
    const observables_t& o = *job.observables;
    lines.push_back(fmt::format("v_xy {:.2f}  v_z {:.2f} mm/s", o.rms_speed_xy_mm_s, o.rms_speed_z_mm_s));
    lines.push_back(fmt::format("n_z {:.3f} (rms)", o.rms_n_z));
    lines.emplace_back("hits of a rod per second:");
    lines.push_back("  " + hits_text(job.hits.rates()));
  }
  return lines;
}

void put_numbers(const LiveJob& job, const Console& console, const Area& area, CellGrid& grid) {
  static constexpr int kLeastChartLines = 5;
  static constexpr int kTallestChart = 16;
  const auto put = [&](int line, const std::string& text) {
    grid.put(area.column, area.line + line, fitted(text, static_cast<std::size_t>(area.columns)), area.columns);
  };
  const std::vector<std::string> lines = number_lines(job, console);
  // Where there is room for a second column, as under a picture, the chart stands there.
  const bool has_side_chart = area.columns >= 72 && area.lines < static_cast<int>(lines.size()) + 1 + kLeastChartLines;
  int n = 0;
  for (const std::string& line : lines) {
    if (n < area.lines) put(n++, line);
  }
  const int height = std::min(kTallestChart, has_side_chart ? area.lines : area.lines - n - 1);
  if (height < kLeastChartLines) return;
  const int first = has_side_chart ? 0 : n + 1;
  const int indent = has_side_chart ? 36 : 0;
  int i = 0;
  for (const std::string& line : order_chart(job, area.columns - indent, height)) {
    grid.put(area.column + indent, area.line + first + i++, line, area.columns - indent);
  }
}

/// What stands in place of the rods as long as there are none.
std::string absence_text(const LiveJob* job) {
  if (job == nullptr) return "no run";
  if (job->draws_film) return "the run is done; " + film_text(*job);
  if (job->state == "queued") return "waits in the queue" + (job->reason.empty() ? "" : ": " + job->reason);
  if (!job->is_running()) return "the run is " + job->state;
  return "no frame has come yet (live frames need LCM, and a \"stream\" block in the scene)";
}

void put_picture(const WatchContent& content, const LiveJob* job, const WatchLayout& layout, CellGrid& grid) {
  const Area& area = layout.picture;
  if (content.rods == nullptr) {
    const std::string text = fitted(absence_text(job), static_cast<std::size_t>(area.columns));
    const int width = static_cast<int>(display_width(text));
    grid.put(area.column + (area.columns - width) / 2, area.line + area.lines / 2, text, width);
    return;
  }
  if (has_director(content, area)) {
    draw_director(*content.rods, content.defects, content.steering.view, rod_style(content), area, grid);
  } else {
    draw_rods(*content.rods, content.defects, content.steering.view, rod_style(content), area, grid);
  }
  put_legend(content, layout.legend, area, grid);
}

void put_help(const Console& console, CellGrid& grid) {
  std::size_t width = 0;
  for (const char* line : kWatchKeys) width = std::max(width, display_width(line));
  const int columns = std::min(grid.columns(), static_cast<int>(width) + 4);
  const int left = (grid.columns() - columns) / 2;
  int line = std::max(0, (grid.lines() - static_cast<int>(std::size(kWatchKeys)) - 4) / 2);
  const auto put = [&](const std::string& text) {
    if (line >= grid.lines()) return;
    for (int column = left; column < left + columns; ++column) grid.at(column, line) = {};
    grid.put(left + 2, line++, text, columns - 2);
  };
  put("");
  put(console.painted(Colour::kBold, "Keys"));
  for (const char* text : kWatchKeys) put(text);
  put("");
}

CellGrid overview_cells(const WatchContent& content, const Console& console) {
  CellGrid grid(console.width, console.height);
  int line = 0;
  const std::string note = "o rods  q leave  ? keys  " + content.note;
  for (const std::string& text : watch_screen(content.jobs, content.title, note, console)) {
    grid.put(0, line++, text);
  }
  return grid;
}

CellGrid run_cells(const WatchContent& content, const WatchLayout& layout, const Console& console) {
  CellGrid grid(console.width, console.height);
  const LiveJob* job = job_in(content.jobs, content.steering.job);
  const std::vector<std::string> jobs = choices(content.jobs);
  const auto place = std::find(jobs.begin(), jobs.end(), content.steering.job);
  std::string title = console.painted(Colour::kBold, content.title);
  if (jobs.size() > 1 && place != jobs.end())
    title += fmt::format("  run {} of {}", place - jobs.begin() + 1, jobs.size());
  if (content.rods != nullptr) title += fmt::format("  t = {:.3f} s", content.rods->time);
  if (content.steering.view.zoom > 1) title += fmt::format("  zoom {:.1f}", content.steering.view.zoom);
  if (content.rods != nullptr && content.depth != ColourDepth::kNone) {
    title += fmt::format("  colours: {}", name_of(content.steering.shown_colouring()));
  }
  if (content.steering.paused) title += "  " + console.painted(Colour::kYellow, "HELD (space)");
  const auto width = static_cast<std::size_t>(grid.columns());
  grid.put(0, 0, fitted(title, width));
  put_picture(content, job, layout, grid);
  if (job != nullptr) put_numbers(*job, console, layout.numbers, grid);
  grid.put(0, grid.lines() - 1,
           fitted(console.painted(Colour::kDim, status_line(content.note, grid.columns())), width));
  return grid;
}

/// Where the terminal is too small: what is needed, how to get numbers all the same, and a line for each run.
CellGrid small_cells(const WatchContent& content, const Console& console) {
  CellGrid grid(console.width, console.height);
  const auto width = static_cast<std::size_t>(std::max(1, grid.columns()));
  int line = 0;
  const auto put = [&](const std::string& text) { grid.put(0, line++, fitted(text, width)); };
  // Not cut: it says what is to be done.
  std::string note = size_note(grid.columns(), grid.lines()) + ". o: numbers, q: leave";
  while (!note.empty() && line < grid.lines()) {
    std::size_t size = std::min(width, note.size());
    if (size < note.size()) {
      if (const std::size_t space = note.rfind(' ', size); space != std::string::npos && space > 0) size = space;
    }
    put(note.substr(0, size));
    note.erase(0, note.find_first_not_of(' ', size));
  }
  for (const LiveJob& job : content.jobs.jobs()) {
    if (job.is_running() && line < grid.lines()) put(watch_line(job));
  }
  return grid;
}

}  // namespace

std::optional<WatchLayout> watch_layout(int columns, int lines) {
  const std::optional<WatchLayout> a = beside(columns, lines), b = stacked(columns, lines);
  if (!a) return b;
  return b && side_of(*b) > side_of(*a) ? b : a;
}

std::string size_note(int columns, int lines) {
  return fmt::format("the rods need a terminal of {}x{} or {}x{}; this one has {}x{}", kFewestColumns, kFewestLines,
                     kFewestStackedColumns, kFewestStackedLines, columns, lines);
}

std::vector<std::string> choices(const LiveJobs& jobs) {
  std::vector<std::string> all, running;
  for (const LiveJob& job : jobs.jobs()) {
    all.push_back(job.id);
    if (job.is_running()) running.push_back(job.id);
  }
  return running.empty() ? all : running;
}

std::string job_to_show(const std::string& job, const LiveJobs& jobs) {
  const LiveJob* present = job_in(jobs, job);
  if (present != nullptr && present->is_running()) return job;
  const std::vector<std::string> others = choices(jobs);
  if (others.empty()) return job;
  // There is more to be seen of one that moves than of one that draws its film.
  const auto moving = std::find_if(others.begin(), others.end(), [&](const std::string& id) {
    const LiveJob& other = *job_in(jobs, id);
    return other.is_running() && !other.draws_film;
  });
  const std::string& next = moving == others.end() ? others.front() : *moving;
  return present == nullptr || job_in(jobs, next)->is_running() ? next : job;
}

CellGrid watch_cells(const WatchContent& content, int columns, int lines) {
  const Console console = painter(content, columns, lines);
  const std::optional<WatchLayout> layout = watch_layout(columns, lines);
  CellGrid grid = content.steering.numbers ? overview_cells(content, console)
                  : layout                 ? run_cells(content, *layout, console)
                                           : small_cells(content, console);
  if (content.steering.help) put_help(console, grid);
  return grid;
}

}  // namespace shaken::client
