#include "scene/schema.h"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "base/keys/schema.h"
#include "scene/keys/fields.h"
#include "scene/keys/values.h"
#include "scene/sweeps/factors.h"
#include "scene/sweeps/sweep_keys.h"

namespace shaken::scene {

namespace {

Schema refer_to(std::string_view definition) { return {{"$ref", fmt::format("#/$defs/{}", definition)}}; }

Schema any_of(std::vector<Schema> schemas) { return {{"anyOf", std::move(schemas)}}; }

Schema array_of(Schema items) { return {{"type", "array"}, {"minItems", 1}, {"items", std::move(items)}}; }

Schema whole_number(int low, int high) { return {{"type", "integer"}, {"minimum", low}, {"maximum", high}}; }

bool is_number(const Field& field) { return field.form == Form::kQuantity || field.form == Form::kWhole; }

std::string range_name(Dimension dimension) { return fmt::format("range of {}", name_of(dimension)); }
std::string values_name(const Field& field) { return fmt::format("values of {}", field.path); }

/// "range of length": several values.
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
    default:
      return any_of({one, array_of(one)});
  }
}

/// One product of a sweep.
Schema product_schema() {
  Schema values = Schema::object();
  Schema single = Schema::object();
  for (const Field& field : fields()) {
    if (field.form == Form::kBlock) continue;
    values[field.path] = refer_to(values_name(field));
    single[field.path] = refer_to(field.path);
  }
  const auto described = [](std::string_view description, Schema schema) {
    schema["description"] = description;
    return schema;
  };
  Schema replicas = whole_number(1, kMaxReplicas);
  replicas["default"] = 1;
  const Schema stages{{"type", "array"}, {"items", object_with(values)}, {"minItems", 1}, {"maxItems", kMaxStages}};
  return object_with(
      {{"grid", described("All combinations of the values of these keys.", object_with(values))},
       {"zip", described("These keys vary together: the first values, the second, ...", object_with(values))},
       {"list", described("Points named one by one.", {{"type", "array"}, {"items", object_with(std::move(single))}})},
       {"stages", described("Runs one after the other, each from where the one before has left the rods.", stages)},
       {"replicas", described("Runs of each point, each with a seed of its own.", std::move(replicas))}});
}

}  // namespace

Schema scene_schema() {
  Schema schema = titled("Scene of Shaken");
  schema.update(object_schema(fields(), By::kReference));
  schema["$defs"] = definitions_of(fields());
  return schema;
}

Schema sweep_schema() {
  Schema definitions = definitions_of(fields());
  for (const Field& field : fields()) {
    if (field.form == Form::kBlock) continue;
    if (is_number(field) && !definitions.contains(range_name(field.dimension))) {
      define_ranges(field.dimension, definitions);
    }
    definitions[values_name(field)] = {{"description", field.doc}};
    definitions[values_name(field)].update(values_schema(field));
  }
  definitions["scene"] = object_schema(fields(), By::kReference);
  definitions["product"] = product_schema();

  const Schema product = refer_to("product");
  Schema in_sweep = object_schema(sweep_keys(), By::kValue)["properties"];
  in_sweep["name"].update({{"minLength", 1}, {"maxLength", 200}, {"pattern", "^(?!\\.{1,2}$)[^/\\u0000-\\u001f]*$"}});
  in_sweep["slurm"]["description"] = "What the runs ask of Slurm, where they run there.";
  in_sweep["scene"] = refer_to("scene");
  in_sweep["sweep"] = {
      {"description", "Which values vary. An array: the points of each of its sweeps, one after the other."},
      {"if", {{"type", "array"}}},
      {"then", array_of(product)},
      {"else", product}};
  Schema schema = titled("Sweep or scene of Shaken");
  schema["properties"] = in_sweep;  // as in "then", for editors to offer in a file that is neither yet
  schema["if"] = any_of({{{"required", {"scene"}}}, {{"required", {"sweep"}}}});
  schema["then"] = object_with(std::move(in_sweep));
  schema["else"] = refer_to("scene");
  schema["$defs"] = std::move(definitions);
  return schema;
}

}  // namespace shaken::scene
