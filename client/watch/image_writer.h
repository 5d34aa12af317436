// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "client/watch/cells.h"
#include "client/watch/graphics.h"
#include "client/watch/rod_image.h"

namespace shaken::client {

/// Brings one image to a terminal, again whenever it changes.
class ImageWriter {
 public:
  /// The bytes that draw `image` over `area` in place of the last one; none if it is there already. `graphics` is
  /// kSixel or kKitty.
  std::string update(const RodImage& image, const Area& area, Graphics graphics);
  /// The bytes that take the image away; none if there is none, or if it is made of sixels, which go with the cells
  /// that are written over them.
  std::string remove();
  bool is_shown() const { return shown_.has_value(); }
  /// The next image is drawn in any case: something else has written on the terminal.
  void forget() { is_forgotten_ = true; }

 private:
  struct Shown {
    RodImage image;
    Area area;
    Graphics graphics;
    friend bool operator==(const Shown&, const Shown&) = default;
  };
  std::optional<Shown> shown_;
  bool is_forgotten_ = false;
};

}  // namespace shaken::client
