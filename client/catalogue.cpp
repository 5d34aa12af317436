#include "client/catalogue.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "base/job_state.h"
#include "base/keys/units.h"
#include "base/steadiness.h"
#include "base/text.h"
#include "client/live/json.h"
#include "render/style_keys.h"
#include "run/files/unit_of_name.h"
#include "run/loop/summary.h"
#include "run/measure/measurement_kinds.h"
#include "scene/canonical.h"
#include "scene/keys/fields.h"
#include "scene/keys/observables.h"
#include "scene/load.h"
#include "sim/effects/registry.h"

namespace shaken::client {
namespace {

using Rows = std::vector<std::pair<std::string, Json>>;

Rows units() {
  Rows rows;
  for (const keys::Unit& unit : keys::units())
    rows.emplace_back(unit.name, Json{{"of", keys::name_of(unit.dimension)}, {"scale", unit.scale()}});
  return rows;
}

Rows symbols_in_names() {
  Rows rows;
  for (const std::string_view symbol : run::unit_symbols()) rows.emplace_back(symbol, Json::object());
  return rows;
}

template <class T>
Json row_of(const keys::Key<T>& key, const keys::Value& fallback) {
  const bool is_plain = key.dimension == keys::Dimension::kPlain;
  return {{"of", keys::name_of(key.dimension)},
          {"unit", is_plain ? key.unit : keys::default_unit(key.dimension)},
          {"range", keys::allowed(key)},
          {"default", to_json(key, fallback)},
          {"title", key.title},
          {"symbol", key.symbol},
          {"doc", key.doc}};
}

Rows keys_of_scenes() {
  const scene::RunPlan plain = *scene::load_scene("{}", "");  // the paper's
  Rows rows;
  for (const scene::Field& field : scene::fields())
    rows.emplace_back(field.path, row_of(field, scene::fields().value(plain, field)));
  return rows;
}

Rows keys_of_styles() {
  Rows rows;
  for (const auto& key : render::style_keys()) rows.emplace_back(key.path, row_of(key, key.fallback));
  return rows;
}

Rows observables() {
  Rows rows;
  for (const scene::Observable& each : scene::observables())
    rows.emplace_back(each.name, Json{{"doc", each.doc},
                                      {"usual", each.is_usual},
                                      {"within_walls", each.within_walls()},
                                      {"among_posts", each.among_posts()}});
  return rows;
}

Json row_of(const run::MeasurementKind& kind, const run::Output& output) {
  return {{"unit", run::unit_of_name(output.name)},
          {"title", output.title},
          {"symbol", output.symbol},
          {"doc", kind.meaning(output)}};
}

Rows arrays() {
  Rows rows;
  for (const run::MeasurementKind& kind : run::measurement_kinds()) {
    const auto path = [&](std::string_view name) { return fmt::format("/{}/{}", kind.name, name); };
    for (const run::Output& array : kind.arrays) {
      Json row = row_of(kind, array);
      row["error"] = array.has_error;
      row["axes"] = Json::array();
      for (const std::string& axis : kind.axes_of(array.name)) row["axes"].push_back(path(axis));
      rows.emplace_back(path(array.name), row);
    }
  }
  return rows;
}

Rows numbers() {
  Rows rows;
  for (const run::MeasurementKind& kind : run::measurement_kinds()) {
    for (const run::Output& number : kind.numbers) {
      Json row = row_of(kind, number);
      row["observable"] = kind.name;
      rows.emplace_back(number.name, row);
    }
  }
  return rows;
}

Rows summary() {
  Rows rows;
  for (const run::SummaryKey& key : run::summary_keys()) {
    Json row{{"doc", key.meaning}, {"if_null", key.if_null}};
    if (!key.unit.empty()) row.update({{"unit", key.unit}, {"title", key.title}, {"symbol", ""}});
    if (!key.averages.empty()) row["averages"] = split(key.averages, ' ');
    rows.emplace_back(key.name, row);
  }
  return rows;
}

Rows job_states() {
  Rows rows;
  for (const JobStateRow& row : kJobStates)
    rows.emplace_back(row.word, Json{{"has_worker", row.has_worker},
                                     {"has_ended", row.has_ended},
                                     {"has_failed", row.has_failed},
                                     {"requests", split(row.requests, ' ')},
                                     {"doc", row.meaning}});
  return rows;
}

Rows steadiness() {
  Rows rows;
  for (const SteadinessRow& row : kSteadiness)
    rows.emplace_back(row.steady ? fmt::to_string(*row.steady) : "null",
                      Json{{"mark", row.mark}, {"word", row.word}, {"advice", row.advice}});
  return rows;
}

Rows effects() {
  Rows rows;
  for (const Effect& effect : all_effects())
    rows.emplace_back(effect.name, Json{{"doc", effect.what}, {"keys", effect.keys}, {"work", effect.unit}});
  return rows;
}

}  // namespace

std::string catalogue() {
  const std::vector<std::pair<const char*, Rows>> sections{{"units", units()},
                                                           {"symbols_in_names", symbols_in_names()},
                                                           {"keys", keys_of_scenes()},
                                                           {"style_keys", keys_of_styles()},
                                                           {"observables", observables()},
                                                           {"arrays", arrays()},
                                                           {"numbers", numbers()},
                                                           {"summary", summary()},
                                                           {"effects", effects()},
                                                           {"job_states", job_states()},
                                                           {"steadiness", steadiness()}};
  std::string text = "{";
  for (const auto& [name, rows] : sections) {
    text += fmt::format("{}\n \"{}\": {{", text.size() > 1 ? "," : "", name);
    for (std::size_t i = 0; i < rows.size(); ++i)
      text += fmt::format("{}\n  {}: {}", i == 0 ? "" : ",", Json(rows[i].first).dump(), rows[i].second.dump());
    text += "}";
  }
  return text + "}\n";
}

}  // namespace shaken::client
