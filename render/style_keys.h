#pragma once

#include <string>

#include "base/keys/table.h"
#include "render/style.h"

namespace shaken::render {

/// All keys of a style, in the order of the help. Style files, the command lines of shaken-render and shaken, their
/// help and the documentation follow from its rows. On a command line a key has - for _; "style", the first, is another
/// option there, which takes files too.
using StyleKey = keys::Key<PictureStyle>;
const keys::Table<PictureStyle>& style_keys();

/// "scale-bar": the name of its option, without dashes.
std::string option_of(const StyleKey& key);
/// The same as it is declared: "--scale-bar", "-c,--colour".
std::string flags_of(const StyleKey& key);

/// Whether it is of films only.
bool is_for_films(const StyleKey& key);

/// Sets `key` from the text of a command line; else says what is wrong with it, without naming the key.
Result<void> set_from_text(PictureStyle& style, const StyleKey& key, const std::string& text);

}  // namespace shaken::render
