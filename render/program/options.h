#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/style.h"

namespace shaken::render {

/// What the command line asks for.
struct Options {
  std::vector<std::string> sources;  ///< run directories or trajectory.h5; of a live picture, one job
  std::string out;
  bool json = false;

  std::string style;                        ///< preset or file; empty: none
  std::map<std::string, std::string> keys;  ///< of the style, as given
  std::map<std::string, bool> switches;     ///< of the style, as given
  std::vector<std::string> labels;          ///< of the sources, in their order
  bool bare = false;

  int depth = 8;  ///< bits a colour
  std::string frame = "last";
  std::string time;

  std::string sweep;  ///< JSON of sweep_places
  std::optional<std::size_t> every;
  std::string from, to;
  bool keep_frames = false;
  int n_threads = 0;
  std::string progress;

  std::string lcm_url;
  double timeout_s = 15;
  std::string preset;
};

/// Options of one subcommand each, and of all that draw. The options must outlive the command line.
void declare_picture(CLI::App& command, Options& options);
void declare_film(CLI::App& command, Options& options);
void declare_live(CLI::App& command, Options& options);

/// The style that the command line asks for, over `style`. Fails with everything that is wrong with it.
PictureStyle style_of(const Options& options, PictureStyle style = {});

/// "10 s", "500ms", "12.5", in seconds; `option` is whose value it is.
double seconds_in(const std::string& text, const char* option);

}  // namespace shaken::render
