// The text of a style file: every style that is taken can be drawn in.
#include <nlohmann/json.hpp>

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
  nlohmann::ordered_json said = nlohmann::ordered_json::object();
  for (const render::StyleKey& key : render::style_keys()) {
    if (key.fetch) said[key.path] = to_json(key, key.fetch(*style));
  }
  fuzz::promise(static_cast<bool>(render::load_style(said.dump(), "again.json", {})), "its values are allowed ones");
  return 0;
}
