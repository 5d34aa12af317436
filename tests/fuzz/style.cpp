// SPDX-License-Identifier: MIT
// The text of a style file: every style that is taken can be drawn in.
#include "render/style_file.h"
#include "render/style_keys.h"
#include "tests/fuzz/fuzz_target.h"

using namespace shaken;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto style = render::load_style(fuzz::text_of(data, size), "fuzz.json", {});
  if (!style) {
    fuzz::promise(!style.error().empty(), "a refusal says why");
    return 0;
  }
  fuzz::promise(static_cast<bool>(render::check(*style)), "a style that is taken is sound");
  for (const render::StyleKey& key : render::style_keys()) {
    const std::string name = key.name;
    if (name == "range" || name == "speed") continue;  // need not be given
    render::PictureStyle copy = *style;
    fuzz::promise(static_cast<bool>(render::set(copy, key, key.fetch(*style))), "its values are allowed ones");
  }
  return 0;
}
