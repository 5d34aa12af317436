#pragma once

#include <filesystem>
#include <utility>

#include "base/core/result.h"
#include "render/image.h"
#include "render/picture.h"
#include "render/rods_pass.h"
#include "render/style.h"

namespace shaken::render {

/// Draws whole pictures: the rods, and on and beside them all that explains them. Make one and use it for many
/// pictures (its start costs tens of milliseconds), from one thread at a time.
class Painter {
 public:
  static Result<Painter> create();
  /// With 8 bits a colour, or with 16: the rods are then drawn as finely, and the words laid over them.
  template <class Channel = std::uint8_t>
  Result<ImageOf<Channel>> paint(const RodPicture& picture, const PictureStyle& style);

  /// Without page and floor; shadows are dark and half clear. `style.transparent` need not be set.
  Result<ClearImage> paint_clear(const RodPicture& picture, PictureStyle style);

 private:
  explicit Painter(RodsPass rods) : rods_(std::move(rods)) {}
  RodsPass rods_;
};

/// The same picture of lines and areas, as ".svg" or ".pdf": rods are their outlines without light and shadow. The file
/// appears, or replaces an older one, only when it is complete.
Result<void> write_vector(const std::filesystem::path& file, const RodPicture& picture, const PictureStyle& style);

}  // namespace shaken::render
