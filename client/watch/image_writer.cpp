// SPDX-License-Identifier: MIT
#include "client/watch/image_writer.h"

#include <fmt/format.h>

#include <utility>

#include "client/watch/kitty.h"
#include "client/watch/sixel.h"

namespace shaken::client {

std::string ImageWriter::update(const RodImage& image, const Area& area, Graphics graphics) {
  Shown next{.image = image, .area = area, .graphics = graphics};
  if (!std::exchange(is_forgotten_, false) && shown_ == next) return {};
  shown_ = std::move(next);
  return fmt::format("\x1b[{};{}H", area.line + 1, area.column + 1) +
         (graphics == Graphics::kKitty ? kitty_text(image) : sixel_text(image));
}

std::string ImageWriter::remove() {
  const std::optional<Shown> last = std::exchange(shown_, std::nullopt);
  return last && last->graphics == Graphics::kKitty ? kitty_removal() : std::string();
}

}  // namespace shaken::client
