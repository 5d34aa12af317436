#include "render/program/options.h"

#include <fmt/format.h>

#include "base/failure.h"
#include "base/keys/units.h"
#include "proto/bus.h"
#include "render/style_file.h"
#include "render/style_keys.h"

namespace shaken::render {
namespace {

constexpr const char* kRuns = "Run directory or trajectory.h5; several are drawn side by side";

void declare_sweep(CLI::App& app, Options& options) {
  app.add_option("--sweep", options.sweep,
                 R"(For --inset sweep: {"x", "y": names, "points": [[X, Y, S]], "here": [[X, Y]] of each run})")
      ->type_name("JSON");
}

void declare_depth(CLI::App& app, Options& options) {
  app.add_option("--depth", options.depth, "Bits a colour of a .png: 8, or 16 for what is worked on afterwards")
      ->check(CLI::IsMember({8, 16}))
      ->capture_default_str()
      ->type_name("BITS");
}

void declare_style(CLI::App& app, Options& options, bool films) {
  app.add_option("--style", options.style,
                 "A preset (`shaken-render style` lists them) or a style file; the options "
                 "below change it")
      ->type_name("NAME|FILE");
  for (const StyleKey& key : style_keys()) {
    if (key.path == "style" || (!films && is_for_films(key))) continue;
    if (key.form == keys::Form::kSwitch) {
      app.add_flag(
          fmt::format("--{0},!--no-{0}", option_of(key)),
          [&options, &key](std::int64_t on) { options.switches[key.path] = on > 0; }, key.doc);
    } else {
      app.add_option(flags_of(key), options.keys[key.path], key.doc)->type_name(value_name(key));
    }
  }
  app.add_option("--label", options.labels,
                 "Headline, one for each run; settings like rods.length=2.5 are written as physicists do")
      ->type_name("TEXT")
      ->expected(1)
      ->take_all();
  app.add_flag("--bare", options.bare, "Only the box, filling the picture; --scale-bar puts a scale bar on it");
  app.add_flag("--json", options.json, "Prints path, frames, size and seconds as JSON");
}

}  // namespace

void declare_picture(CLI::App& command, Options& options) {
  command.add_option("run", options.sources, kRuns)->required();
  command.add_option("-o,--out", options.out, "File: .png, .svg or .pdf [picture.png beside the trajectory]")
      ->type_name("FILE");
  CLI::Option* frame = command.add_option("--frame", options.frame, "Frame, counted from 0")->type_name("N|last");
  command.add_option("--time", options.time, "The frame nearest to this simulated time: 12.5, 500ms")
      ->type_name("TIME")
      ->excludes(frame);
  declare_depth(command, options);
  declare_sweep(command, options);
  declare_style(command, options, false);
}

void declare_film(CLI::App& command, Options& options) {
  command.add_option("run", options.sources, kRuns)->required();
  command
      .add_option("-o,--out", options.out,
                  "File: .mp4, .webm or .gif [movie.mp4 beside the trajectory]; FOLDER/ for numbered frames; - for "
                  "raw frames (rgb24) on stdout")
      ->type_name("FILE");
  command.add_option("--every", options.every, "Takes every N-th frame [as the scene's movie.every says]")
      ->check(CLI::Range(1, 1000000000))
      ->type_name("N");
  command.add_option("--from", options.from, "Begins at this simulated time: 10, 10s, 500ms")->type_name("TIME");
  command.add_option("--to", options.to, "Ends at this simulated time")->type_name("TIME");
  command.add_flag("--frames", options.keep_frames,
                   "Keeps the frames too, in frames/frame_000000.png beside the movie");
  command.add_option("--threads", options.n_threads, "Threads that draw [one per core]")
      ->check(CLI::Range(1, 256))
      ->type_name("N");
  command.add_option("--progress", options.progress, "Keeps in this file, as JSON, how far it is")->type_name("FILE");
  declare_sweep(command, options);
  declare_style(command, options, true);
}

void declare_live(CLI::App& command, Options& options) {
  options.lcm_url = proto::default_url();
  command.add_option("job", options.sources, "The job's id, or the beginning of it")->required()->expected(1);
  command.add_option("-o,--out", options.out, "File: .png, .svg or .pdf")->required()->type_name("FILE");
  command.add_option("--lcm-url", options.lcm_url, "The bus")->capture_default_str()->type_name("URL");
  command.add_option("--timeout", options.timeout_s, "How long to wait for a frame")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str()
      ->type_name("S");
  declare_depth(command, options);
  declare_style(command, options, false);
}

PictureStyle style_of(const Options& options, PictureStyle style) {
  if (!options.style.empty()) style = value_or_fail(named_style(options.style, style), ExitCode::kBadInput);
  std::string wrong;
  for (const StyleKey& key : style_keys()) {
    if (const auto given = options.keys.find(key.path); given != options.keys.end() && !given->second.empty()) {
      const Result<void> done = set_from_text(style, key, given->second);
      if (!done) wrong += fmt::format("{}--{}: {}", wrong.empty() ? "" : "\n", option_of(key), done.error().message);
    }
    if (const auto given = options.switches.find(key.path); given != options.switches.end()) {
      key.store(style, given->second);
    }
  }
  if (!wrong.empty()) throw Failure(ExitCode::kBadInput, wrong);
  if (options.bare) {
    style.caption = style.legend = style.time_bar = false;
    style.scale_bar = options.switches.contains("scale_bar") && options.switches.at("scale_bar");
  }
  done_or_fail(check(style), ExitCode::kBadInput);
  return style;
}

double seconds_in(const std::string& text, const char* option) {
  const Result<double> time = keys::parse_quantity(text, keys::Dimension::kTime);
  if (!time) throw Failure(ExitCode::kBadInput, fmt::format("{}: {}", option, time.error().message));
  return *time;
}

}  // namespace shaken::render
