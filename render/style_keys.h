// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/core/result.h"
#include "render/style.h"

namespace shaken::render {

/// A value of a style: a switch, a number, a word, or two numbers.
using StyleValue = std::variant<bool, double, std::string, Vec2>;

/// How a key is written.
enum class StyleForm {
  kSwitch,  ///< true or false; on the command line --KEY and --no-KEY
  kNumber,
  kWord,  ///< one of `words`, or what `store` accepts
  kPair,  ///< [x, y]; on the command line X,Y
  kSize,  ///< [width, height], whole numbers; on the command line WIDTHxHEIGHT
};

/// One key of a style. Files, the command line, the help and the documentation follow from its row.
struct StyleKey {
  const char* name;  ///< on the command line with - for _
  StyleForm form;
  const char* value_name;  ///< in the help
  std::string doc;         ///< one line
  double low, high;        ///< of numbers, each of two
  std::vector<std::string> words;
  std::function<StyleValue(const PictureStyle&)> fetch;
  /// Takes a value of the right form and in range; says what else is wrong with it.
  std::function<Result<void>(PictureStyle&, const StyleValue&)> store;
};

/// All of them, in the order of the help.
std::span<const StyleKey> style_keys();
/// Null if there is none of this name.
const StyleKey* find_style_key(std::string_view name);

/// Sets `key` to `value`, if it may have it; else says what it may have, without naming the key.
Result<void> set(PictureStyle& style, const StyleKey& key, const StyleValue& value);
/// The same from the command line's text.
Result<void> set_from_text(PictureStyle& style, const StyleKey& key, const std::string& text);

/// "[64, 5000] x [64, 5000]", "light, dark or print".
std::string allowed(const StyleKey& key);

/// All of them as a table in Markdown (docs/pictures.md).
std::string style_keys_as_markdown();

}  // namespace shaken::render
