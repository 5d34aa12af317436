#pragma once

namespace shaken {

/// What a side of a picture or film may have, for scenes and for the renderer alike [pixels].
constexpr int kLeastPixels = 64, kMostPixels = 7680;

}  // namespace shaken
