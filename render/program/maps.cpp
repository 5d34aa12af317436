// SPDX-License-Identifier: MIT
#include "render/program/maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "base/failure.h"
#include "base/stopwatch.h"
#include "render/colourings.h"
#include "render/headline.h"
#include "render/painter.h"
#include "render/png.h"
#include "render/program/runs.h"
#include "render/ticks.h"

namespace shaken::render {
namespace {

/// A point of the sweep.
struct Place {
  double x, y;
  std::string directory;
};

std::vector<Place> places_in(const nlohmann::json& said) {
  std::vector<Place> places;
  for (const auto& cell : said.at("cells")) {
    places.push_back(
        {cell.at(0).get<double>(), cell.at(1).is_null() ? 0 : cell.at(1).get<double>(), cell.at(2).get<std::string>()});
  }
  if (places.empty()) throw std::invalid_argument("there are no cells");
  return places;
}

std::size_t index_in(const std::set<double>& values, double value) {
  return static_cast<std::size_t>(std::distance(values.begin(), values.find(value)));
}

}  // namespace

void make_map(const Options& options) {
  const Stopwatch watch;
  PictureStyle style = style_of(options);
  if (std::filesystem::path(options.out).extension() != ".png") {
    throw Failure(ExitCode::kBadInput, fmt::format("a map is written as .png, not as '{}'", options.out));
  }
  if (style.view != ViewPoint::kTop) throw Failure(ExitCode::kBadInput, "a map has its rods from above");
  if (style.transparent) throw Failure(ExitCode::kBadInput, "--transparent is for pictures of one instant, not a map");
  style.mark_defects = false;  // on so small pictures they would hide the rods
  PhaseMap map;
  std::vector<Place> places;
  try {
    const auto said = nlohmann::json::parse(options.sweep);
    const std::string x = said.at("x").get<std::string>(), y = said.at("y").get<std::string>();
    map.x.title = axis_of(x);
    if (!y.empty()) map.y.title = axis_of(y);
    places = places_in(said);
  } catch (const std::exception& error) {
    throw Failure(ExitCode::kBadInput, std::string("the map is not as it should be: ") + error.what());
  }
  std::set<double> columns, rows;
  for (const Place& place : places) {
    columns.insert(place.x);
    rows.insert(place.y);
  }
  for (const double value : columns) map.x.values.push_back(tick_text(value));
  for (const double value : rows) map.y.values.push_back(map.y.title.empty() ? "" : tick_text(value));
  std::vector<double> orders;
  for (const Place& place : places) {
    PhaseMap::Cell& cell = map.cells.emplace_back();
    cell.column = index_in(columns, place.x);
    cell.row = index_in(rows, place.y);
    Result<TrajectorySource> source = TrajectorySource::open(place.directory);
    if (!source) continue;
    cell.picture = value_or_fail(source->picture(source->n_frames() - 1, style));
    orders.push_back(cell.picture->found.order);
  }
  const auto any = std::find_if(map.cells.begin(), map.cells.end(), [](const auto& cell) { return cell.picture; });
  if (any == map.cells.end()) throw Failure(ExitCode::kFailed, "no run of this sweep has a frame yet");
  // One colouring for all, as there is one legend.
  if (style.colour == "auto") style.colour = chosen_colour(*any->picture, orders, false);
  Painter painter = value_or_fail(Painter::create(), ExitCode::kFailed);
  const Image image = value_or_fail(painter.paint_map(map, style), ExitCode::kFailed);
  done_or_fail(write_png(options.out, image, any->picture->captions.notes, style.dpi.value_or(0)));
  report(options, options.out, 1, style, watch.seconds());
}

}  // namespace shaken::render
