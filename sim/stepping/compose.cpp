// SPDX-License-Identifier: MIT
#include "sim/stepping/compose.h"

#include "sim/stepping/phases.h"

namespace shaken {
namespace {

using phases::Effects;
using phases::FrictionlessLaw;

template <class Law, bool kAtInstant, bool kRough>
Kernels::MeetSurfaces surfaces_with() {
  return &phases::meet_surfaces<Effects<Law, kAtInstant, kRough>>;
}

template <class Law, bool kAtInstant>
Kernels::Respond response_with() {
  return &phases::respond<Effects<Law, kAtInstant, false>>;
}

template <class Law>
Kernels::MeetSurfaces surfaces_by(bool at_instant, bool rough) {
  if (at_instant) return rough ? surfaces_with<Law, true, true>() : surfaces_with<Law, true, false>();
  return rough ? surfaces_with<Law, false, true>() : surfaces_with<Law, false, false>();
}

template <class Law>
Kernels::Respond response_by(bool at_instant) {
  return at_instant ? response_with<Law, true>() : response_with<Law, false>();
}

/// Both kernels, by the scene's law where there is friction.
Kernels by_law(const Scene& scene, bool surface_friction, bool rod_friction, bool rough) {
  const bool at_instant = scene.impacts == ImpactTime::kAtInstant;
  Kernels kernels{surfaces_by<FrictionlessLaw>(at_instant, rough), response_by<FrictionlessLaw>(at_instant)};
  const auto put = [&]<class Law>(Law) {
    if (surface_friction) kernels.meet_surfaces = surfaces_by<Law>(at_instant, rough);
    if (rod_friction) kernels.respond = response_by<Law>(at_instant);
  };
  switch (scene.law) {
    case ImpulseLaw::kNewton:
      put(NewtonLaw{});
      break;
    case ImpulseLaw::kPoisson:
      put(PoissonLaw{});
      break;
    case ImpulseLaw::kEnergetic:
      put(EnergeticLaw{});
      break;
  }
  return kernels;
}

}  // namespace

Kernels compose(const Scene& scene) {
  const bool surface_friction = (scene.base && scene.rod_base.friction > 0) ||
                                (scene.lid && scene.rod_lid.friction > 0) ||
                                (scene.walls && scene.walls->contact.friction > 0);
  return by_law(scene, surface_friction, scene.rod_rod.friction > 0, scene.rotational_noise > 0);
}

Kernels compose_everything(const Scene& scene) { return by_law(scene, true, true, true); }

}  // namespace shaken
