#pragma once

namespace shaken {

/// Speed at which a bead must leave the base where plates are too weak to throw rods: those at rest would sink [mm/s].
/// What falls for a tick and is then stopped, or thrown back by a fraction of that, has sunk a little. Leaving at half
/// the speed of a tick's fall, it is back where it was after a tick; what several contacts of a rod still sink, or what
/// was deep before, `rise_rate` brings out again.
struct RestSpeed {
  double half_fall = 0;  ///< g dt / 2, or 0 where plates throw rods: there it would never matter [mm/s]
  double rise_rate = 0;  ///< more of it per overlap [1/s]
  double at(double overlap) const { return half_fall + rise_rate * overlap; }
  bool matters() const { return half_fall > 0; }
};

}  // namespace shaken
