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
  static bool is_on(const System& system) { return system.gravity > 0; }
  static std::string why(const System& system) { return setting("gravity", system.gravity, " mm/s^2"); }
  static std::int64_t work(const World& world) { return world.tick * n_rods(world); }
  static void switch_off(System& system) { system.gravity = 0; }
};

struct Vibration {
  static bool is_on(const System& system) { return system.amplitude > 0 && system.frequency > 0; }
  static std::string why(const System& system) {
    return setting("plates.amplitude", system.amplitude, " mm, ") +
           setting("plates.frequency", system.frequency, " Hz");
  }
  static std::int64_t work(const World& world) {
    const double time = static_cast<double>(world.tick) * world.system.dt;
    return static_cast<std::int64_t>(std::floor(time * world.system.frequency));
  }
  static void switch_off(System& system) { system.amplitude = 0; }
};

struct Tilt {
  static bool is_on(const System& system) { return !system.is_planar(); }
  static std::string why(const System& system) {
    if (system.is_planar()) return "no base, no lid, gravity = 0";
    if (system.base) return "plates.base = true";
    return system.lid ? "plates.lid = true" : setting("gravity", system.gravity, " mm/s^2");
  }
  static std::int64_t work(const World& world) { return world.tick * n_rods(world); }
  static void switch_off(System& system) {
    system.base = system.lid = false;
    system.gravity = 0;
  }
};

struct SeveralSpecies {
  static bool is_on(const System& system) { return system.added[0] || system.added[1]; }
  static std::string why(const System& system) {
    if (system.added[0]) return setting("rods_2.count", system.added[0]->count);
    return system.added[1] ? setting("rods_3.count", system.added[1]->count) : "neither rods_2 nor rods_3";
  }
  static std::int64_t work(const World& world) {
    return n_rods(world) - static_cast<std::int64_t>(world.system.n_rods);
  }
  static void switch_off(System& system) { system.added = {}; }
};

struct Taper {
  static bool is_on(const RodShape& rod) {
    if (rod.bead_diameters.empty()) return rod.n_beads > 1 && rod.end_diameter != rod.mid_diameter;
    return std::any_of(rod.bead_diameters.begin(), rod.bead_diameters.end(),
                       [&](double diameter) { return diameter != rod.bead_diameters.front(); });
  }
  static bool is_on(const System& system) {
    return is_on(system.rod) || std::any_of(system.added.begin(), system.added.end(),
                                            [](const auto& added) { return added && is_on(added->rod); });
  }
  static std::string why(const System& system) {
    if (!is_on(system.rod) && is_on(system)) return "rods_2 or rods_3";
    if (!system.rod.bead_diameters.empty()) return "rods.bead_diameters";
    if (system.rod.n_beads == 1) return setting("rods.beads", 1);
    return setting("rods.mid_diameter", system.rod.mid_diameter, " mm, ") +
           setting("rods.end_diameter", system.rod.end_diameter, " mm");
  }
  static std::int64_t work(const World& world) { return n_rods(world); }
  static void switch_off(System& system) {
    const auto straighten = [](RodShape& rod) {
      rod.end_diameter = rod.mid_diameter;
      std::fill(rod.bead_diameters.begin(), rod.bead_diameters.end(), rod.mid_diameter);
    };
    straighten(system.rod);
    for (auto& added : system.added) {
      if (added) straighten(added->rod);
    }
  }
};

// --- what one kind of contact does

struct RodRod {
  static constexpr const char* kKey = "contacts.rod_rod";
  static constexpr auto kParameters = &System::rod_rod;
  static constexpr auto kImpulses = &Counters::impulses_rod_rod;
};
struct RodBase {
  static constexpr const char* kKey = "contacts.rod_base";
  static constexpr auto kParameters = &System::rod_base;
  static constexpr auto kImpulses = &Counters::impulses_rod_base;
  static constexpr const char* kPlate = "plates.base";
  static constexpr auto kIsThere = &System::base;
};
struct RodLid {
  static constexpr const char* kKey = "contacts.rod_lid";
  static constexpr auto kParameters = &System::rod_lid;
  static constexpr auto kImpulses = &Counters::impulses_rod_lid;
  static constexpr const char* kPlate = "plates.lid";
  static constexpr auto kIsThere = &System::lid;
};

struct RodCollisions {
  static bool is_on(const System& system) { return system.n_all_rods() > 1; }
  static std::string why(const System& system) { return setting("rods.count", system.n_rods); }
  static std::int64_t work(const World& world) { return world.counters.impulses_rod_rod; }
  static constexpr void (*switch_off)(System&) = nullptr;
};

template <class Contact>
struct PlateCollisions {
  static bool is_on(const System& system) { return system.*Contact::kIsThere; }
  static std::string why(const System& system) {
    return std::string(Contact::kPlate) + (is_on(system) ? " = true" : " = false");
  }
  static std::int64_t work(const World& world) { return world.counters.*Contact::kImpulses; }
  static void switch_off(System& system) { system.*Contact::kIsThere = false; }
};

/// Both bodies of a kind of contact are there.
template <class Contact>
bool is_there(const System& system) {
  if constexpr (requires { Contact::kIsThere; }) {
    return system.*Contact::kIsThere;
  } else {
    return true;
  }
}

template <class Contact>
struct Friction {
  static double mu(const System& system) { return (system.*Contact::kParameters).friction; }
  static bool is_on(const System& system) {
    return is_there<Contact>(system) && (system.*Contact::kParameters).has_friction();
  }
  static std::string why(const System& system) { return setting(std::string(Contact::kKey) + ".friction", mu(system)); }
  static std::int64_t work(const World& world) { return world.counters.*Contact::kImpulses; }
  static void switch_off(System& system) { (system.*Contact::kParameters).friction = 0; }
};

template <class Contact>
struct Restitution {
  static double e(const System& system) { return (system.*Contact::kParameters).restitution; }
  static bool is_on(const System& system) { return is_there<Contact>(system) && e(system) > 0; }
  static std::string why(const System& system) {
    return setting(std::string(Contact::kKey) + ".restitution", e(system));
  }
  static std::int64_t work(const World& world) { return world.counters.*Contact::kImpulses; }
  static void switch_off(System& system) { (system.*Contact::kParameters).restitution = 0; }
};

struct WallCollisions {
  static bool is_on(const System& system) { return system.walls.has_value(); }
  static std::string why(const System& system) {
    return system.walls ? setting("walls.size", system.walls->size, " mm") : "no walls: the box is periodic";
  }
  static std::int64_t work(const World& world) { return world.counters.impulses_rod_wall; }
  static void switch_off(System& system) { system.walls.reset(); }
};

struct WallFriction {
  static bool is_on(const System& system) { return system.walls && system.walls->contact.has_friction(); }
  static std::string why(const System& system) {
    return system.walls ? setting("walls.friction", system.walls->contact.friction) : WallCollisions::why(system);
  }
  static std::int64_t work(const World& world) { return world.counters.impulses_rod_wall; }
  static void switch_off(System& system) {
    if (system.walls) system.walls->contact.friction = 0;
  }
};

struct RotationalNoise {
  static bool is_on(const System& system) { return system.has_rotational_noise(); }
  static std::string why(const System& system) { return setting("plates.noise", system.rotational_noise, " rad/mm"); }
  static std::int64_t work(const World& world) { return world.counters.noise_kicks; }
  static void switch_off(System& system) { system.rotational_noise = 0; }
};

struct ImpactsAtInstant {
  static bool is_on(const System& system) { return system.has_impacts_at_instant(); }
  static std::string why(const System& system) {
    return is_on(system) ? "time.impacts = at_instant" : "time.impacts = tick_end";
  }
  static std::int64_t work(const World& world) { return world.counters.impacts_at_instant; }
  static void switch_off(System& system) { system.impacts = ImpactTime::kTickEnd; }
};

/// A rod's spin about its own axis: an impulse along the normal passes through that axis, so only friction changes it.
struct Spin {
  template <class Contact>
  static std::int64_t rubbed(const World& world) {
    return Friction<Contact>::is_on(world.system) ? world.counters.*Contact::kImpulses : 0;
  }
  static bool is_on(const System& system) {
    return Friction<RodRod>::is_on(system) || Friction<RodBase>::is_on(system) || Friction<RodLid>::is_on(system) ||
           WallFriction::is_on(system);
  }
  static std::string why(const System& system) {
    if (Friction<RodRod>::is_on(system)) return Friction<RodRod>::why(system);
    if (Friction<RodBase>::is_on(system)) return Friction<RodBase>::why(system);
    if (Friction<RodLid>::is_on(system)) return Friction<RodLid>::why(system);
    return WallFriction::is_on(system) ? WallFriction::why(system) : "every friction = 0";
  }
  static std::int64_t work(const World& world) {
    return rubbed<RodRod>(world) + rubbed<RodBase>(world) + rubbed<RodLid>(world) +
           (WallFriction::is_on(world.system) ? WallFriction::work(world) : 0);
  }
  static void switch_off(System& system) {
    Friction<RodRod>::switch_off(system);
    Friction<RodBase>::switch_off(system);
    Friction<RodLid>::switch_off(system);
    WallFriction::switch_off(system);
  }
};

/// A line of the table: `E` says when it is on and what it did.
template <class E>
constexpr Effect line(std::string_view name, std::string_view unit, std::string_view what) {
  return {name,
          what,
          [](const System& system) { return E::is_on(system); },
          E::why,
          [](const World& world) { return E::is_on(world.system) ? E::work(world) : std::int64_t{0}; },
          unit,
          E::switch_off};
}

constexpr std::array kEffects{
    line<Gravity>("gravity", "rod_ticks", "Rods fall."),
    line<Vibration>("vibration", "periods", "Both plates vibrate."),
    line<Tilt>("tilt", "rod_ticks", "Rods leave the plane and tilt out of it."),
    line<SeveralSpecies>("species", "rods", "Rods of other species beside the first."),
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
