#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/keys/rules.h"

namespace shaken::keys {

/// JSON Schemas (draft 2020-12, with no keyword that editors of draft 7 need and lack), made from rules. They say of
/// each key its meaning, unit, range and default. What a table accepts they accept too. The reverse does not hold: a
/// schema knows nothing of keys that contradict each other, of the range of a quantity that is written with a unit, of
/// comments (which are allowed), and of duplicate keys.
using Schema = nlohmann::ordered_json;

/// Whether the schema of a key stands where the key does, or is a reference to its definition (definitions_of).
enum class By { kValue, kReference };

/// The object at `path` of a text; "" is the text itself.
Schema object_schema(const Rules& rules, By by, std::string_view path = {});
/// What may be written for each key that is no block, by its path.
Schema definitions_of(const Rules& rules);

/// A whole text of these keys.
Schema document_schema(std::string_view title, const Rules& rules);
/// The beginning of such a one.
Schema titled(std::string_view title);
/// An object with these keys and no others.
Schema object_with(Schema properties, Schema required = Schema::array());

/// A number and perhaps a unit, as a regular expression; and what an editor says of texts that do not fit it.
std::string quantity_pattern(Dimension dimension);
std::string quantity_meaning(Dimension dimension);
/// Holds a text to `pattern`. `meaning` is what an editor says of others: VS Code and its relatives know the keyword,
/// and validators pass over it.
void match(std::string_view pattern, std::string_view meaning, Schema& schema);

}  // namespace shaken::keys
