#include "render/sweep_map.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "render/headline.h"

namespace shaken::render {

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
