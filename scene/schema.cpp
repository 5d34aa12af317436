// SPDX-License-Identifier: MIT
#include "scene/schema.h"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "scene/canonical.h"
#include "scene/factors.h"
#include "scene/fields.h"
#include "scene/points.h"
#include "scene/slurm_settings.h"
#include "scene/units.h"
#include "scene/values.h"

namespace shaken::scene {

namespace {

using Schema = nlohmann::ordered_json;

// What parse_decimal reads.
constexpr std::string_view kNumber = "[-+]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)?";

Schema refer_to(std::string_view definition) { return {{"$ref", fmt::format("#/$defs/{}", definition)}}; }

Schema any_of(std::vector<Schema> schemas) { return {{"anyOf", std::move(schemas)}}; }

Schema array_of(Schema items) { return {{"type", "array"}, {"minItems", 1}, {"items", std::move(items)}}; }

/// An object with these keys and no others.
Schema object_with(Schema properties, Schema required = Schema::array()) {
  Schema schema{{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

Schema whole_number(int low, int high) { return {{"type", "integer"}, {"minimum", low}, {"maximum", high}}; }

Schema link_to_schema() {
  return {{"description", "The schema of this file, for editors; ignored otherwise."}, {"type", "string"}};
}

/// A number and perhaps a unit, as a regular expression.
std::string quantity_pattern(Dimension dimension) {
  std::string names;
  for (const Unit& unit : units_of(dimension)) {
    if (!names.empty()) names += '|';
    for (const char c : unit.name) {
      if (c == '^') names += '\\';
      names += c;
    }
  }
  return fmt::format("[ \\t]*{}[ \\t]*{}[ \\t]*", kNumber, names.empty() ? "" : fmt::format("({})?", names));
}

/// Holds a text to `pattern`. `meaning` is what an editor says of others: VS Code and its relatives know the keyword,
/// and validators pass over it.
void match(std::string_view pattern, std::string_view meaning, Schema& schema) {
  schema["pattern"] = fmt::format("^{}$", pattern);
  schema["patternErrorMessage"] = meaning;
}

/// "A number, or a text with a unit: mm, m, cm, um."
std::string quantity_meaning(Dimension dimension) {
  std::string names;
  for (const Unit& unit : units_of(dimension)) {
    const bool is_ascii = static_cast<unsigned char>(unit.name.front()) < 0x80;
    if (is_ascii) names += fmt::format("{}{}", names.empty() ? "" : ", ", unit.name);
  }
  return names.empty() ? "A number without unit." : fmt::format("A number, or a text with a unit: {}.", names);
}

/// The limits of a field's numbers.
void limit(const Field& field, Schema& schema) {
  const auto written = [&](double bound) { return to_json(field, Value(bound)); };
  schema["maximum"] = written(field.high);
  if (!field.or_zero) {
    schema["minimum"] = written(field.low);
  } else {
    schema["anyOf"] = {{{"const", 0}}, {{"minimum", written(field.low)}}};
  }
}

/// One number of a field: as such or as a text.
Schema number_of(const Field& field) {
  const bool whole = field.form != Form::kQuantity && field.form != Form::kNumbers;
  Schema schema{{"type", {whole ? "integer" : "number", "string"}}};
  limit(field, schema);
  if (whole) {
    match(kNumber, "A whole number.", schema);
  } else {
    match(quantity_pattern(field.dimension), quantity_meaning(field.dimension), schema);
  }
  return schema;
}

/// "Length from tip to tip. Allowed: [0.05, 50] mm. Default: 4.5 mm."
std::string description_of(const Field& field) {
  std::string range;
  if (field.form == Form::kWhole) {
    range = fmt::format(" Allowed: {:.16g} to {:.16g}.", field.low, field.high);
  } else if (field.form == Form::kQuantity || field.form == Form::kNumbers) {
    range = fmt::format(" Allowed: {}.", range_of(field));
  }
  const std::string fallback = field.fallback_note.empty() ? show(field, field.fallback) : field.fallback_note;
  return fmt::format("{}{} Default: {}.", field.doc, range, fallback);
}

/// What may be written for a field that is no block.
Schema field_schema(const Field& field) {
  Schema schema{{"description", description_of(field)}};
  if (field.fallback_note.empty()) schema["default"] = to_json(field, field.fallback);
  switch (field.form) {
    case Form::kQuantity:
    case Form::kWhole: {
      Schema number = number_of(field);
      number["type"].push_back("null");
      if (field.names.empty()) {
        schema.update(number);
      } else {
        schema["anyOf"] = {{{"enum", field.names}}, number};
      }
      break;
    }
    case Form::kName:
      schema["enum"] = field.names;
      schema["enum"].push_back(nullptr);
      break;
    case Form::kRunId:
      schema.update({{"type", {"string", "null"}}, {"pattern", "^[0-9a-f]{16}$"}});
      break;
    case Form::kSwitch:
      schema["type"] = {"boolean", "null"};
      break;
    case Form::kSize: {
      Schema side = number_of(field);
      side["multipleOf"] = 2;
      schema.update({{"type", {"array", "null"}}, {"items", side}, {"minItems", 2}, {"maxItems", 2}});
      break;
    }
    case Form::kNumbers:
      schema.update({{"type", {"array", "null"}}, {"items", number_of(field)}, {"minItems", 1}});
      break;
    case Form::kBlock:
      break;
  }
  return schema;
}

/// The object at `path` of a scene; "" is the scene itself.
Schema object_at_path(std::string_view path) {
  Schema properties = Schema::object();
  if (path.empty()) properties["$schema"] = link_to_schema();
  for (const std::string& name : names_in(path)) {
    const std::string inner = path.empty() ? name : fmt::format("{}.{}", path, name);
    const int index = field_index(inner);
    const bool is_leaf = index >= 0 && fields()[static_cast<std::size_t>(index)].form != Form::kBlock;
    properties[name] = is_leaf ? refer_to(inner) : object_at_path(inner);
  }
  Schema schema = object_with(std::move(properties));
  if (path.empty()) return schema;
  const int index = field_index(path);
  if (index >= 0) {
    schema["type"] = {"object", "boolean", "null"};
    schema["description"] = description_of(fields()[static_cast<std::size_t>(index)]);
  } else {
    schema["type"] = {"object", "null"};
  }
  return schema;
}

Schema field_definitions() {
  Schema definitions = Schema::object();
  for (const Field& field : fields()) {
    if (field.form != Form::kBlock) definitions[field.path] = field_schema(field);
  }
  return definitions;
}

bool is_number(const Field& field) { return field.form == Form::kQuantity || field.form == Form::kWhole; }

std::string range_name(Dimension dimension) { return fmt::format("range of {}", name_of(dimension)); }
std::string interval_name(Dimension dimension) { return fmt::format("interval of {}", name_of(dimension)); }
std::string values_name(const Field& field) { return fmt::format("values of {}", field.path); }

/// "range of length", "interval of length": several values, and where values are drawn.
void define_ranges(Dimension dimension, Schema& definitions) {
  const std::string quantity = quantity_pattern(dimension);
  Schema number{{"type", {"number", "string"}}};
  match(quantity, quantity_meaning(dimension), number);
  const Schema scale{{"description", "linear: even differences; log: even ratios."},
                     {"enum", {"linear", "log"}},
                     {"default", "linear"}};
  Schema text{{"description", "from:to:step"}, {"type", "string"}};
  match(fmt::format("{0}:{0}:{0}", quantity), "Values, or a range from:to:step.", text);
  Schema by_step = object_with({{"from", number}, {"to", number}, {"step", number}}, {"from", "to", "step"});
  Schema by_count = object_with(
      {{"from", number}, {"to", number}, {"n", whole_number(1, kMaxPoints)}, {"scale", scale}}, {"from", "to", "n"});
  definitions[range_name(dimension)] = any_of({std::move(text), std::move(by_step), std::move(by_count)});
  definitions[interval_name(dimension)] =
      object_with({{"from", number}, {"to", number}, {"scale", scale}}, {"from", "to"});
}

/// What read_values reads.
Schema values_schema(const Field& field) {
  const Schema one = refer_to(field.path);
  switch (field.form) {
    case Form::kQuantity:
    case Form::kWhole: {
      const Schema range = refer_to(range_name(field.dimension));
      return any_of({one, range, array_of(any_of({one, range}))});
    }
    case Form::kSize:  // an array of numbers is one size, one of arrays several
      return any_of({one, array_of(refer_to(values_name(field)))});
    case Form::kNumbers:  // an array of numbers could be one list or several numbers: only an array of lists is clear
      return any_of({{{"type", "null"}}, array_of(one)});
    default:
      return any_of({one, array_of(one)});
  }
}

/// One product of a sweep.
Schema product_schema() {
  Schema values = Schema::object();
  Schema single = Schema::object();
  Schema drawn{{"n", whole_number(1, kMaxPoints)}, {"seed", whole_number(0, 1 << 30)}};
  drawn["n"]["description"] = "Number of points.";
  drawn["seed"].update({{"description", "Other seeds draw other points."}, {"default", 1}});
  for (const Field& field : fields()) {
    if (field.form == Form::kBlock) continue;
    values[field.path] = refer_to(values_name(field));
    single[field.path] = refer_to(field.path);
    if (is_number(field)) drawn[field.path] = refer_to(interval_name(field.dimension));
  }
  const auto described = [](std::string_view description, Schema schema) {
    schema["description"] = description;
    return schema;
  };
  Schema draws = object_with(std::move(drawn), {"n"});
  draws["minProperties"] = 2;
  Schema sobol = draws;
  sobol["maxProperties"] = 2 + kMaxSobolDimensions;
  Schema replicas = whole_number(1, kMaxReplicas);
  replicas["default"] = 1;
  return object_with(
      {{"grid", described("All combinations of the values of these keys.", object_with(values))},
       {"zip", described("These keys vary together: the first values, the second, ...", object_with(values))},
       {"list", described("Points named one by one.", {{"type", "array"}, {"items", object_with(std::move(single))}})},
       {"random", described("Independent random points.", draws)},
       {"latin", described("A Latin hypercube: one point in each nth of each interval.", draws)},
       {"sobol", described("Sobol's sequence, scrambled by the seed.", std::move(sobol))},
       {"replicas", described("Runs of each point, each with a seed of its own.", std::move(replicas))}});
}

/// What the runs of a sweep ask of Slurm.
Schema slurm_schema() {
  Schema keys = Schema::object();
  for (const SlurmKey& key : slurm_keys()) {
    keys[key.name] = {{"description", key.doc + " Default: " + key.fallback + "."}};
    keys[key.name]["anyOf"] = Schema::array({{{"type", "null"}}, key.schema});
  }
  Schema schema = object_with(std::move(keys));
  schema["description"] = "What the runs ask of Slurm, where they run there.";
  return schema;
}

Schema titled(std::string_view title) {
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
}

}  // namespace

Schema scene_schema() {
  Schema schema = titled("Scene of Shaken");
  schema.update(object_at_path(""));
  schema["$defs"] = field_definitions();
  return schema;
}

Schema sweep_schema() {
  Schema definitions = field_definitions();
  for (const Field& field : fields()) {
    if (field.form == Form::kBlock) continue;
    if (is_number(field) && !definitions.contains(range_name(field.dimension))) {
      define_ranges(field.dimension, definitions);
    }
    definitions[values_name(field)] = {{"description", field.doc}};
    definitions[values_name(field)].update(values_schema(field));
  }
  definitions["scene"] = object_at_path("");
  definitions["product"] = product_schema();

  const Schema product = refer_to("product");
  Schema in_sweep{
      {"$schema", link_to_schema()},
      {"name",
       {{"description", "Name of the sweep; that of the file if left out."},
        {"type", "string"},
        {"minLength", 1},
        {"maxLength", 200},
        {"pattern", "^(?!\\.{1,2}$)[^/\\u0000-\\u001f]*$"}}},
      {"executor",
       {{"description", "Where the runs run; where the daemon's do if left out."}, {"enum", executor_names()}}},
      {"slurm", slurm_schema()},
      {"scene", refer_to("scene")},
      {"sweep",
       {{"description", "Which values vary. An array: the points of each of its sweeps, one after the other."},
        {"if", {{"type", "array"}}},
        {"then", array_of(product)},
        {"else", product}}}};
  Schema schema = titled("Sweep or scene of Shaken");
  schema["properties"] = in_sweep;  // as in "then", for editors to offer in a file that is neither yet
  schema["if"] = any_of({{{"required", {"scene"}}}, {{"required", {"sweep"}}}});
  schema["then"] = object_with(std::move(in_sweep));
  schema["else"] = refer_to("scene");
  schema["$defs"] = std::move(definitions);
  return schema;
}

}  // namespace shaken::scene
