#include "base/keys/schema.h"

#include <fmt/format.h>

#include <utility>

namespace shaken::keys {

namespace {

// What parse_decimal reads.
constexpr std::string_view kNumber = "[-+]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)?";

/// One number of a key: as such or as a text.
Schema number_of(const Rule& rule) {
  const bool whole = rule.form == Form::kWhole || rule.form == Form::kSize;
  Schema schema{{"type", {whole ? "integer" : "number", "string"}}};
  const auto written = [&](double bound) { return to_json(rule, Value(bound)); };
  schema["maximum"] = written(rule.high);
  if (!rule.or_zero) {
    schema["minimum"] = written(rule.low);
  } else {
    schema["anyOf"] = {{{"const", 0}}, {{"minimum", written(rule.low)}}};
  }
  if (whole) {
    match(kNumber, "A whole number.", schema);
  } else {
    match(quantity_pattern(rule.dimension), quantity_meaning(rule.dimension), schema);
  }
  if (rule.only_even) schema["multipleOf"] = 2;
  return schema;
}

Schema text_of(const Rule& rule) {
  if (!rule.names.empty()) return {{"enum", rule.names}};
  Schema schema{{"type", "string"}};
  // as a whole, whatever it may choose between
  const bool chooses = rule.pattern.find('|') != std::string::npos;
  if (!rule.pattern.empty()) schema["pattern"] = chooses ? "^(" + rule.pattern + ")$" : "^" + rule.pattern + "$";
  return schema;
}

/// "Length from tip to tip. Allowed: [0.05, 50] mm. Default: 4.5 mm."
std::string description_of(const Rule& rule) {
  std::string range;
  if (rule.form == Form::kWhole) {
    range = fmt::format(" Allowed: {:.16g} to {:.16g}.", rule.low, rule.high);
  } else if (rule.form == Form::kQuantity || rule.form == Form::kNumbers || rule.form == Form::kPair ||
             rule.form == Form::kPairs) {
    range = fmt::format(" Allowed: {}.", range_of(rule));
  }
  return fmt::format("{}{}{} Default: {}.", rule.doc, rule.doc.ends_with('.') ? "" : ".", range, fallback_of(rule));
}

/// What may be written for a key that is no block.
Schema value_schema(const Rule& rule) {
  Schema schema{{"description", description_of(rule)}};
  if (rule.fallback_note.empty() && rule.fallback.index() != 0) schema["default"] = to_json(rule, rule.fallback);
  const auto list_of = [&](const Schema& items, std::size_t least, std::size_t most) {
    schema.update({{"type", {"array", "null"}}, {"items", items}});
    if (least > 0) schema["minItems"] = least;
    if (most > 0) schema["maxItems"] = most;
  };
  switch (rule.form) {
    case Form::kQuantity:
    case Form::kWhole: {
      Schema number = number_of(rule);
      number["type"].push_back("null");
      if (rule.names.empty()) {
        schema.update(number);
      } else {
        schema["anyOf"] = {{{"enum", rule.names}}, number};
      }
      break;
    }
    case Form::kName:
      schema["enum"] = rule.names;
      schema["enum"].push_back(nullptr);
      break;
    case Form::kText:
      schema.update(text_of(rule));
      schema["type"] = {"string", "null"};
      break;
    case Form::kTexts:
      list_of(text_of(rule), 0, rule.most);
      break;
    case Form::kSwitch:
      schema["type"] = {"boolean", "null"};
      break;
    case Form::kPair:
    case Form::kSize:
      list_of(number_of(rule), 2, 2);
      break;
    case Form::kNumbers:
      list_of(number_of(rule), 1, 0);
      break;
    case Form::kPairs: {
      const Schema pair{{"type", "array"}, {"items", number_of(rule)}, {"minItems", 2}, {"maxItems", 2}};
      list_of(pair, 1, rule.most);
      break;
    }
    case Form::kBlock:
    case Form::kElsewhere:
      break;
  }
  return schema;
}

}  // namespace

Schema object_schema(const Rules& rules, By by, std::string_view path) {
  Schema properties = Schema::object();
  if (path.empty()) {
    properties["$schema"] = {{"description", "The schema of this file, for editors; ignored otherwise."},
                             {"type", "string"}};
  }
  for (const std::string& name : rules.names_in(path)) {
    const std::string inner = path.empty() ? name : fmt::format("{}.{}", path, name);
    const int index = rules.index(inner);
    const Rule* rule = index < 0 ? nullptr : rules.rules()[static_cast<std::size_t>(index)];
    if (rule == nullptr || rule->form == Form::kBlock) {
      properties[name] = object_schema(rules, by, inner);
      properties[name]["type"] = {"object", "null"};
      if (rule == nullptr) continue;
      properties[name]["type"] = {"object", "boolean", "null"};
      properties[name]["description"] = description_of(*rule);
    } else if (by == By::kValue) {
      properties[name] = value_schema(*rule);
    } else {
      properties[name] = {{"$ref", fmt::format("#/$defs/{}", inner)}};
    }
  }
  return object_with(std::move(properties));
}

Schema definitions_of(const Rules& rules) {
  Schema definitions = Schema::object();
  for (const Rule* rule : rules.rules()) {
    if (rule->form != Form::kBlock) definitions[rule->path] = value_schema(*rule);
  }
  return definitions;
}

Schema document_schema(std::string_view title, const Rules& rules) {
  Schema schema = titled(title);
  schema.update(object_schema(rules, By::kValue));
  return schema;
}

Schema titled(std::string_view title) {
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
}

Schema object_with(Schema properties, Schema required) {
  Schema schema{{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

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

std::string quantity_meaning(Dimension dimension) {
  std::string names;
  for (const Unit& unit : units_of(dimension)) {
    const bool is_ascii = static_cast<unsigned char>(unit.name.front()) < 0x80;
    if (is_ascii) names += fmt::format("{}{}", names.empty() ? "" : ", ", unit.name);
  }
  return names.empty() ? "A number without unit." : fmt::format("A number, or a text with a unit: {}.", names);
}

void match(std::string_view pattern, std::string_view meaning, Schema& schema) {
  schema["pattern"] = fmt::format("^{}$", pattern);
  schema["patternErrorMessage"] = meaning;
}

}  // namespace shaken::keys
