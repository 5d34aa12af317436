#include "render/headline.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/keys/units.h"
#include "scene/keys/fields.h"

namespace shaken::render {
namespace {

/// What a key of a scene is called where it is swept: "ℓ" of "rods.length"; its last word if it has no symbol.
std::string symbol_of(const std::string& path) {
  const std::string symbol = scene::field_index(path) < 0 ? "" : scene::field_at(path).symbol;
  return symbol.empty() ? path.substr(path.rfind('.') + 1) : symbol;
}

/// One setting, or nothing if `word` is none.
std::string spoken(const std::string& word) {
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos) return "";
  const std::string path = word.substr(0, equals), value = word.substr(equals + 1);
  if (path == "replica") return "replica " + value;
  if (scene::field_index(path) < 0) return "";
  const scene::Field& field = scene::field_at(path);
  const auto number = keys::parse_quantity(value, field.dimension);
  const bool is_plain = field.form != keys::Form::kQuantity || field.dimension == keys::Dimension::kPlain;
  return fmt::format("{} = {}", symbol_of(path),
                     number && !is_plain ? keys::format_quantity(*number, field.dimension) : value);
}

}  // namespace

std::string headline(const std::string& label) {
  std::string all;
  std::istringstream words(label);
  bool was_setting = true;
  for (std::string word; words >> word;) {
    const std::string setting = spoken(word);
    const bool is_setting = !setting.empty();
    if (!all.empty()) all += is_setting && was_setting ? ", " : " ";
    all += is_setting ? setting : word;
    was_setting = is_setting;
  }
  return all;
}

Notes settings_of(const RodPicture& picture) {
  const Cell& cell = picture.cell;
  Notes settings;
  const std::size_t n_species = cell.n_species();
  if (n_species > 1) settings.emplace_back("", fmt::format("{} species", n_species));
  if (n_species == 1) {
    settings.emplace_back(cell.has_axes() ? "\u2113" : "d", picture.length_text());
  }
  settings.emplace_back("\u03c6", fmt::format("{:.2f}", picture.area_fraction()));
  settings.emplace_back("N", fmt::format("{}", picture.n_rods()));
  settings.emplace_back("w", fmt::format("{:.4g} mm", cell.gap));
  if (!cell.walls && cell.box.x() == cell.box.y()) {
    settings.emplace_back("L", fmt::format("{:.4g} mm", cell.box.x()));
  } else if (!cell.walls) {
    settings.emplace_back("L", fmt::format("{:.4g} \u00d7 {:.4g} mm", cell.box.x(), cell.box.y()));
  }
  if (cell.walls) {
    const SideWalls& walls = *cell.walls;
    std::string size = fmt::format("{:.4g}", walls.size);
    if (walls.has_length()) size = fmt::format("{:.4g} \u00d7 {}", walls.extent().x(), size);
    if (walls.arena == Arena::kChannel) settings.emplace_back("L", fmt::format("{:.4g} mm", cell.box.x()));
    settings.emplace_back("", fmt::format("{} of {} mm", name_of(walls.arena), size));
  }
  return settings;
}

void name_runs(const std::vector<Captions*>& runs) {
  const auto said = [](const auto& setting) {
    return setting.first.empty() ? setting.second : setting.first + " = " + setting.second;
  };
  const auto append = [](std::string& all, const std::string& text) { all += (all.empty() ? "" : ", ") + text; };
  if (runs.size() == 1) {
    Captions& run = *runs.front();
    run.label.clear();
    run.subtitle.clear();
    constexpr std::size_t kHeadline = 4;  // what is of the rods
    for (std::size_t i = 0; i < run.settings.size(); ++i) {
      append(i < kHeadline ? run.label : run.subtitle, said(run.settings[i]));
    }
    return;
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i]->label.clear();
    runs[i]->subtitle.clear();
    for (const auto& setting : runs[i]->settings) {
      const bool all_have_it = std::all_of(runs.begin(), runs.end(), [&](const Captions* other) {
        return std::find(other->settings.begin(), other->settings.end(), setting) != other->settings.end();
      });
      if (!all_have_it) append(runs[i]->label, said(setting));
    }
  }
  const bool any = std::any_of(runs.begin(), runs.end(), [](const Captions* run) { return !run->label.empty(); });
  for (std::size_t i = 0; !any && i < runs.size(); ++i) runs[i]->label = fmt::format("run {}", i + 1);
}

Result<SweepPlaces> sweep_places(const std::string& json, std::size_t n_runs) {
  const auto number = [](const nlohmann::json& value) {
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  };
  try {
    const auto said = nlohmann::json::parse(json);
    SweepMap map{symbol_of(said.at("x").get<std::string>()), symbol_of(said.at("y").get<std::string>()), {}};
    const auto place = [&](const nlohmann::json& at) {
      Vec2 point(at.at(0).get<double>(), map.y.empty() ? 0 : at.at(1).get<double>());
      if (!point.allFinite()) throw std::invalid_argument("a point is not finite");
      return point;
    };
    for (const auto& point : said.at("points")) map.points.push_back({place(point), number(point.at(2))});
    SweepPlaces places;
    for (const auto& at : said.at("here")) places.here.push_back(place(at));
    if (places.here.size() != n_runs) return Error{"--sweep tells the place of another number of runs"};
    places.map = std::make_shared<const SweepMap>(std::move(map));
    return places;
  } catch (const std::exception& error) {
    return Error{std::string("--sweep is not as it should be: ") + error.what()};
  }
}

}  // namespace shaken::render
