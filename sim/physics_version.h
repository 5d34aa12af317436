// SPDX-License-Identifier: MIT
#pragma once

namespace shaken {

/// Raised whenever a scene's trajectory changes by as much as a bit. A checkpoint is continued by programs of the same
/// version only, and it is part of every run's name; summary.json tells it, CHANGELOG.md what each one changed.
inline constexpr int kPhysicsVersion = 3;

}  // namespace shaken
