// SPDX-License-Identifier: MIT
#include "sim/effects/registry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace shaken {
namespace {

std::string setting(const std::string& key, double value, const char* unit = "") {
  char text[100];
  std::snprintf(text, sizeof text, "%s = %.6g%s", key.c_str(), value, unit);
  return text;
}

std::int64_t n_rods(const World& world) { return static_cast<std::int64_t>(world.rods.size()); }

// --- what every rod does

struct Gravity {
  static bool is_on(const Scene& scene) { return scene.gravity > 0; }
  static std::string why(const Scene& scene) { return setting("gravity", scene.gravity, " mm/s^2"); }
  static std::int64_t work(const World& world) { return world.tick * n_rods(world); }
  static void switch_off(Scene& scene) { scene.gravity = 0; }
};

struct Vibration {
  static bool is_on(const Scene& scene) { return scene.amplitude > 0 && scene.frequency > 0; }
  static std::string why(const Scene& scene) {
    return setting("plates.amplitude", scene.amplitude, " mm, ") + setting("plates.frequency", scene.frequency, " Hz");
  }
  static std::int64_t work(const World& world) {
    const double time = static_cast<double>(world.tick) * world.scene.dt;
    return static_cast<std::int64_t>(std::floor(time * world.scene.frequency));
  }
  static void switch_off(Scene& scene) { scene.amplitude = 0; }
};

struct Tilt {
  static bool is_on(const Scene& scene) { return !scene.is_planar(); }
  static std::string why(const Scene& scene) {
    if (scene.is_planar()) return "no base, no lid, gravity = 0";
    if (scene.base) return "plates.base = true";
    return scene.lid ? "plates.lid = true" : setting("gravity", scene.gravity, " mm/s^2");
  }
  static std::int64_t work(const World& world) { return world.tick * n_rods(world); }
  static void switch_off(Scene& scene) {
    scene.base = scene.lid = false;
    scene.gravity = 0;
  }
};

struct SeveralSpecies {
  static bool is_on(const Scene& scene) { return scene.added[0] || scene.added[1]; }
  static std::string why(const Scene& scene) {
    if (scene.added[0]) return setting("rods_2.count", scene.added[0]->count);
    return scene.added[1] ? setting("rods_3.count", scene.added[1]->count) : "neither rods_2 nor rods_3";
  }
  static std::int64_t work(const World& world) { return n_rods(world) - static_cast<std::int64_t>(world.scene.n_rods); }
  static void switch_off(Scene& scene) { scene.added = {}; }
};

struct Taper {
  static bool is_on(const RodShape& rod) {
    if (rod.bead_diameters.empty()) return rod.n_beads > 1 && rod.end_diameter != rod.mid_diameter;
    return std::any_of(rod.bead_diameters.begin(), rod.bead_diameters.end(),
                       [&](double diameter) { return diameter != rod.bead_diameters.front(); });
  }
  static bool is_on(const Scene& scene) {
    return is_on(scene.rod) || std::any_of(scene.added.begin(), scene.added.end(),
                                           [](const auto& added) { return added && is_on(added->rod); });
  }
  static std::string why(const Scene& scene) {
    if (!is_on(scene.rod) && is_on(scene)) return "rods_2 or rods_3";
    if (!scene.rod.bead_diameters.empty()) return "rods.bead_diameters";
    if (scene.rod.n_beads == 1) return setting("rods.beads", 1);
    return setting("rods.mid_diameter", scene.rod.mid_diameter, " mm, ") +
           setting("rods.end_diameter", scene.rod.end_diameter, " mm");
  }
  static std::int64_t work(const World& world) { return n_rods(world); }
  static void switch_off(Scene& scene) {
    const auto straighten = [](RodShape& rod) {
      rod.end_diameter = rod.mid_diameter;
      std::fill(rod.bead_diameters.begin(), rod.bead_diameters.end(), rod.mid_diameter);
    };
    straighten(scene.rod);
    for (auto& added : scene.added) {
      if (added) straighten(added->rod);
    }
  }
};

// --- what one kind of contact does

struct RodRod {
  static constexpr const char* kKey = "contacts.rod_rod";
  static constexpr auto kParameters = &Scene::rod_rod;
  static constexpr auto kImpulses = &Counters::impulses_rod_rod;
};
struct RodBase {
  static constexpr const char* kKey = "contacts.rod_base";
  static constexpr auto kParameters = &Scene::rod_base;
  static constexpr auto kImpulses = &Counters::impulses_rod_base;
  static constexpr const char* kPlate = "plates.base";
  static constexpr auto kIsThere = &Scene::base;
};
struct RodLid {
  static constexpr const char* kKey = "contacts.rod_lid";
  static constexpr auto kParameters = &Scene::rod_lid;
  static constexpr auto kImpulses = &Counters::impulses_rod_lid;
  static constexpr const char* kPlate = "plates.lid";
  static constexpr auto kIsThere = &Scene::lid;
};

struct RodCollisions {
  static bool is_on(const Scene& scene) { return scene.n_all_rods() > 1; }
  static std::string why(const Scene& scene) { return setting("rods.count", scene.n_rods); }
  static std::int64_t work(const World& world) { return world.counters.impulses_rod_rod; }
  static constexpr void (*switch_off)(Scene&) = nullptr;
};

template <class Contact>
struct PlateCollisions {
  static bool is_on(const Scene& scene) { return scene.*Contact::kIsThere; }
  static std::string why(const Scene& scene) {
    return std::string(Contact::kPlate) + (is_on(scene) ? " = true" : " = false");
  }
  static std::int64_t work(const World& world) { return world.counters.*Contact::kImpulses; }
  static void switch_off(Scene& scene) { scene.*Contact::kIsThere = false; }
};

/// Both bodies of a kind of contact are there.
template <class Contact>
bool is_there(const Scene& scene) {
  if constexpr (requires { Contact::kIsThere; }) {
    return scene.*Contact::kIsThere;
  } else {
    return true;
  }
}

template <class Contact>
struct Friction {
  static double mu(const Scene& scene) { return (scene.*Contact::kParameters).friction; }
  static bool is_on(const Scene& scene) {
    return is_there<Contact>(scene) && (scene.*Contact::kParameters).has_friction();
  }
  static std::string why(const Scene& scene) { return setting(std::string(Contact::kKey) + ".friction", mu(scene)); }
  static std::int64_t work(const World& world) { return world.counters.*Contact::kImpulses; }
  static void switch_off(Scene& scene) { (scene.*Contact::kParameters).friction = 0; }
};

template <class Contact>
struct Restitution {
  static double e(const Scene& scene) { return (scene.*Contact::kParameters).restitution; }
  static bool is_on(const Scene& scene) { return is_there<Contact>(scene) && e(scene) > 0; }
  static std::string why(const Scene& scene) { return setting(std::string(Contact::kKey) + ".restitution", e(scene)); }
  static std::int64_t work(const World& world) { return world.counters.*Contact::kImpulses; }
  static void switch_off(Scene& scene) { (scene.*Contact::kParameters).restitution = 0; }
};

struct WallCollisions {
  static bool is_on(const Scene& scene) { return scene.walls.has_value(); }
  static std::string why(const Scene& scene) {
    return scene.walls ? setting("walls.size", scene.walls->size, " mm") : "no walls: the box is periodic";
  }
  static std::int64_t work(const World& world) { return world.counters.impulses_rod_wall; }
  static void switch_off(Scene& scene) { scene.walls.reset(); }
};

struct WallFriction {
  static bool is_on(const Scene& scene) { return scene.walls && scene.walls->contact.has_friction(); }
  static std::string why(const Scene& scene) {
    return scene.walls ? setting("walls.friction", scene.walls->contact.friction) : WallCollisions::why(scene);
  }
  static std::int64_t work(const World& world) { return world.counters.impulses_rod_wall; }
  static void switch_off(Scene& scene) {
    if (scene.walls) scene.walls->contact.friction = 0;
  }
};

struct RotationalNoise {
  static bool is_on(const Scene& scene) { return scene.has_rotational_noise(); }
  static std::string why(const Scene& scene) { return setting("plates.noise", scene.rotational_noise, " rad/mm"); }
  static std::int64_t work(const World& world) { return world.counters.noise_kicks; }
  static void switch_off(Scene& scene) { scene.rotational_noise = 0; }
};

struct ImpactsAtInstant {
  static bool is_on(const Scene& scene) { return scene.has_impacts_at_instant(); }
  static std::string why(const Scene& scene) {
    return is_on(scene) ? "time.impacts = at_instant" : "time.impacts = tick_end";
  }
  static std::int64_t work(const World& world) { return world.counters.impacts_at_instant; }
  static void switch_off(Scene& scene) { scene.impacts = ImpactTime::kTickEnd; }
};

/// A rod's spin about its own axis: an impulse along the normal passes through that axis, so only friction changes it.
struct Spin {
  template <class Contact>
  static std::int64_t rubbed(const World& world) {
    return Friction<Contact>::is_on(world.scene) ? world.counters.*Contact::kImpulses : 0;
  }
  static bool is_on(const Scene& scene) {
    return Friction<RodRod>::is_on(scene) || Friction<RodBase>::is_on(scene) || Friction<RodLid>::is_on(scene) ||
           WallFriction::is_on(scene);
  }
  static std::string why(const Scene& scene) {
    if (Friction<RodRod>::is_on(scene)) return Friction<RodRod>::why(scene);
    if (Friction<RodBase>::is_on(scene)) return Friction<RodBase>::why(scene);
    if (Friction<RodLid>::is_on(scene)) return Friction<RodLid>::why(scene);
    return WallFriction::is_on(scene) ? WallFriction::why(scene) : "every friction = 0";
  }
  static std::int64_t work(const World& world) {
    return rubbed<RodRod>(world) + rubbed<RodBase>(world) + rubbed<RodLid>(world) +
           (WallFriction::is_on(world.scene) ? WallFriction::work(world) : 0);
  }
  static void switch_off(Scene& scene) {
    Friction<RodRod>::switch_off(scene);
    Friction<RodBase>::switch_off(scene);
    Friction<RodLid>::switch_off(scene);
    WallFriction::switch_off(scene);
  }
};

/// A line of the table: `E` says when it is on and what it did.
template <class E>
constexpr Effect line(std::string_view name, std::string_view unit, std::string_view what) {
  return {name,
          what,
          [](const Scene& scene) { return E::is_on(scene); },
          E::why,
          [](const World& world) { return E::is_on(world.scene) ? E::work(world) : std::int64_t{0}; },
          unit,
          E::switch_off};
}

constexpr std::array kEffects{
    line<Gravity>("gravity", "rod_ticks", "Rods fall."),
    line<Vibration>("vibration", "periods", "Both plates vibrate."),
    line<Tilt>("tilt", "rod_ticks", "Rods leave the plane and tilt out of it."),
    line<SeveralSpecies>("species", "rods", "Rods of other kinds beside the first."),
    line<Taper>("taper", "rods", "Rods are thinner at their ends than in the middle, or thicker."),
    line<Spin>("spin", "impulses", "Rods spin about their own axes."),
    line<RodCollisions>("rod_rod_collisions", "impulses", "Rods collide with each other."),
    line<Friction<RodRod>>("rod_rod_friction", "impulses", "Coulomb's friction between two rods."),
    line<Restitution<RodRod>>("rod_rod_restitution", "impulses", "Rods bounce off each other."),
    line<PlateCollisions<RodBase>>("rod_base_collisions", "impulses", "Rods collide with the base."),
    line<Friction<RodBase>>("rod_base_friction", "impulses", "Coulomb's friction between rod and base."),
    line<Restitution<RodBase>>("rod_base_restitution", "impulses", "Rods bounce off the base."),
    line<PlateCollisions<RodLid>>("rod_lid_collisions", "impulses", "Rods collide with the lid."),
    line<Friction<RodLid>>("rod_lid_friction", "impulses", "Coulomb's friction between rod and lid."),
    line<Restitution<RodLid>>("rod_lid_restitution", "impulses", "Rods bounce off the lid."),
    line<WallCollisions>("side_walls", "impulses", "Walls round an arena."),
    line<WallFriction>("side_wall_friction", "impulses", "Coulomb's friction between rod and side wall."),
    line<RotationalNoise>("rotational_noise", "kicks", "Rough plates turn rods at random."),
    line<ImpactsAtInstant>("impacts_at_instant", "impulses", "Impacts take place at their own instant in a tick."),
};

}  // namespace

std::span<const Effect> all_effects() { return kEffects; }

}  // namespace shaken
