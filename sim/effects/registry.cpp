// SPDX-License-Identifier: MIT
#include "sim/effects/registry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <type_traits>
#include <vector>

namespace shaken {
namespace {

std::string setting(const std::string& key, double value, const char* unit = "") {
  char text[100];
  std::snprintf(text, sizeof text, "%s = %.6g%s", key.c_str(), value, unit);
  return text;
}

std::int64_t n_rods(const World& world) { return static_cast<std::int64_t>(world.rods.size()); }

// --- what every rod does

struct Falling {
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

struct HorizontalVibration {
  static bool is_on(const System& system) { return system.has_horizontal_vibration(); }
  static std::string why(const System& system) {
    return setting("plates.horizontal_amplitude", system.horizontal_amplitude, " mm, ") +
           setting("plates.frequency", system.frequency, " Hz");
  }
  static std::int64_t work(const World& world) { return Vibration::work(world); }
  static void switch_off(System& system) { system.horizontal_amplitude = 0; }
};

struct SecondVibrationOfPlates {
  static bool is_on(const System& system) { return system.has_second_vibration(); }
  static std::string why(const System& system) {
    const SecondVibration second = system.second.value_or(SecondVibration{0, 0, 0});
    return setting("plates.second.amplitude", second.amplitude, " mm, ") +
           setting("plates.second.frequency", second.frequency, " Hz");
  }
  static std::int64_t work(const World& world) {
    const double time = static_cast<double>(world.tick) * world.system.dt;
    return static_cast<std::int64_t>(std::floor(time * world.system.second->frequency));
  }
  static void switch_off(System& system) { system.second.reset(); }
};

struct LidByItself {
  static bool is_on(const System& system) { return system.has_lid_motion(); }
  static std::string why(const System& system) {
    if (!system.lid_motion) return "no plates.lid_motion";
    return setting("plates.lid_motion.amplitude", system.lid_motion->amplitude, " mm, ") +
           setting("plates.lid_motion.phase", system.lid_motion->phase, " degrees");
  }
  static std::int64_t work(const World& world) { return world.counters.impulses_rod_lid; }
  static void switch_off(System& system) { system.lid_motion.reset(); }
};

struct Inclination {
  static bool is_on(const System& system) { return system.has_inclination(); }
  static std::string why(const System& system) { return setting("plates.inclination", system.inclination, " degrees"); }
  static std::int64_t work(const World& world) { return world.tick * n_rods(world); }
  static void switch_off(System& system) { system.inclination = 0; }
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

struct Polydispersity {
  static bool is_on(const System& system) { return !why_on(system).empty(); }
  static std::string why(const System& system) {
    const std::string key = why_on(system);
    return key.empty() ? setting("rods.length_spread", system.rod.spread.length) : key;
  }
  static std::int64_t work(const World& world) { return n_rods(world); }
  static void switch_off(System& system) {
    system.rod.spread = {};
    for (auto& added : system.added) {
      if (added) added->rod.spread = {};
    }
  }

 private:
  /// The first key that asks for it, with its value, or nothing.
  static std::string why_on(const System& system) {
    std::string key = of(system.rod, "rods");
    for (std::size_t k = 0; k < system.added.size() && key.empty(); ++k) {
      if (system.added[k]) key = of(system.added[k]->rod, "rods_" + std::to_string(k + 2));
    }
    return key;
  }
  static std::string of(const RodShape& rod, const std::string& name) {
    if (rod.spread.length > 0) return setting(name + ".length_spread", rod.spread.length);
    return rod.spread.end_diameter > 0 ? setting(name + ".end_diameter_spread", rod.spread.end_diameter) : "";
  }
};

struct Taper {
  static bool is_on(const RodShape& rod) {
    if (rod.bead_diameters.empty())
      return rod.n_beads > 1 && (rod.end_diameter != rod.mid_diameter || rod.spread.end_diameter > 0);
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
      rod.spread.end_diameter = 0;
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
  static constexpr auto kImpulses = &Counters::impulses_rod_rod;
  static constexpr bool kIsOfTwoRods = true;
  static bool is_there(const System&) { return true; }
  static auto& of(auto& system) { return system.rod_rod; }
};
struct RodBase {
  static constexpr const char* kKey = "contacts.rod_base";
  static constexpr auto kImpulses = &Counters::impulses_rod_base;
  static constexpr const char* kPlate = "plates.base";
  static constexpr auto kIsThere = &System::base;
  static constexpr bool kIsOfTwoRods = false;
  static bool is_there(const System& system) { return system.base; }
  static auto& of(auto& system) { return system.rod_base; }
};
struct RodLid {
  static constexpr const char* kKey = "contacts.rod_lid";
  static constexpr auto kImpulses = &Counters::impulses_rod_lid;
  static constexpr const char* kPlate = "plates.lid";
  static constexpr auto kIsThere = &System::lid;
  static constexpr bool kIsOfTwoRods = false;
  static bool is_there(const System& system) { return system.lid; }
  static auto& of(auto& system) { return system.rod_lid; }
};
struct RodWall {
  static constexpr const char* kKey = "walls";
  static constexpr auto kImpulses = &Counters::impulses_rod_wall;
  static constexpr bool kIsOfTwoRods = false;
  static bool is_there(const System& system) { return system.walls.has_value(); }
  static auto& of(auto& system) { return system.walls->contact; }
};

struct RodPost {
  static constexpr const char* kKey = "posts";
  static constexpr auto kImpulses = &Counters::impulses_rod_post;
  static constexpr bool kIsOfTwoRods = false;
  static bool is_there(const System& system) { return system.posts.has_value(); }
  static auto& of(auto& system) { return system.posts->contact; }
};

/// Whether a system says what the contacts of one kind are like: of walls and posts only where it has them.
template <class Contact>
bool has_values(const System& system) {
  constexpr bool is_optional = std::is_same_v<Contact, RodWall> || std::is_same_v<Contact, RodPost>;
  return !is_optional || Contact::is_there(system);
}

/// Does something with every kind of contact.
template <class Do>
void each_kind(const Do& act) {
  act(RodRod{});
  act(RodBase{});
  act(RodLid{});
  act(RodWall{});
  act(RodPost{});
}

/// One pair of materials that may meet in a scene.
struct Pairing {
  std::string key;  ///< "contacts.rod_rod", "contacts.rod_base.rods_2"
  ContactParameters contact;
  OwnContact own;  ///< what is not as for the first species
};

std::string species_name(std::size_t number) { return number == 0 ? "rods" : "rods_" + std::to_string(number + 1); }

/// All of a kind, that of the first species in front; none where one of its bodies is missing.
template <class Contact>
std::vector<Pairing> pairings(const System& system) {
  if (!Contact::is_there(system)) return {};
  const Contacts& contacts = Contact::of(system);
  std::vector<Pairing> all{{Contact::kKey, contacts, {}}};
  for (std::size_t b = 1; b < kMostSpecies; ++b) {
    for (std::size_t a = 0; a <= (Contact::kIsOfTwoRods ? b : 0); ++a) {
      if (!system.has_species(a) || !system.has_species(b)) continue;
      const std::string partners = (Contact::kIsOfTwoRods ? species_name(a) + "_" : "") + species_name(b);
      all.push_back(
          {std::string(Contact::kKey) + "." + partners, contacts.of(a, b), contacts.own[Contacts::place(a, b)]});
    }
  }
  return all;
}

/// The first of those for which `asks` holds.
template <class Contact, class Asks>
std::optional<Pairing> first_pairing(const System& system, const Asks& asks) {
  for (const Pairing& one : pairings<Contact>(system)) {
    if (asks(one)) return one;
  }
  return std::nullopt;
}

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

struct WallCollisions {
  static bool is_on(const System& system) { return system.walls.has_value(); }
  static std::string why(const System& system) {
    return system.walls ? setting("walls.size", system.walls->size, " mm") : "no walls: the box is periodic";
  }
  static std::int64_t work(const World& world) { return world.counters.impulses_rod_wall; }
  static void switch_off(System& system) { system.walls.reset(); }
};

struct PostCollisions {
  static bool is_on(const System& system) { return system.posts.has_value(); }
  static std::string why(const System& system) {
    return system.posts ? setting("posts.diameter", system.posts->diameter, " mm") : "no posts";
  }
  static std::int64_t work(const World& world) { return world.counters.impulses_rod_post; }
  static void switch_off(System& system) { system.posts.reset(); }
};

/// A value of contacts that is on where any pair of materials has it above 0.
template <class Contact, auto value, auto own_value>
struct ContactValue {
  static auto first(const System& system) {
    return first_pairing<Contact>(system, [](const Pairing& one) { return one.contact.*value > 0; });
  }
  static bool is_on(const System& system) { return first(system).has_value(); }
  static std::string why(const System& system, const char* name) {
    if (const auto one = first(system)) return setting(one->key + name, one->contact.*value);
    if constexpr (std::is_same_v<Contact, RodWall>) {
      if (!system.walls) return WallCollisions::why(system);
    }
    if constexpr (std::is_same_v<Contact, RodPost>) {
      if (!system.posts) return PostCollisions::why(system);
    }
    return setting(std::string(Contact::kKey) + name, Contact::of(system).*value);
  }
  static std::int64_t work(const World& world) { return world.counters.*Contact::kImpulses; }
  static void switch_off(System& system) {
    if (!has_values<Contact>(system)) return;
    Contacts& contacts = Contact::of(system);
    contacts.*value = 0;
    for (OwnContact& own : contacts.own) (own.*own_value).reset();
  }
};

template <class Contact>
struct Friction : ContactValue<Contact, &ContactParameters::friction, &OwnContact::friction> {
  static std::string why(const System& system) {
    return ContactValue<Contact, &ContactParameters::friction, &OwnContact::friction>::why(system, ".friction");
  }
};

template <class Contact>
struct Restitution : ContactValue<Contact, &ContactParameters::restitution, &OwnContact::restitution> {
  static std::string why(const System& system) {
    return ContactValue<Contact, &ContactParameters::restitution, &OwnContact::restitution>::why(system,
                                                                                                 ".restitution");
  }
};

/// An effect on contacts of every kind, which is on where any pair of materials `has` it.
template <class Effect>
struct OnContacts {
  static bool is_on(const System& system) {
    bool any = false;
    each_kind([&](auto kind) { any |= first_pairing<decltype(kind)>(system, Effect::has).has_value(); });
    return any;
  }
  static std::string why(const System& system) {
    std::string key;
    each_kind([&](auto kind) {
      const auto found = first_pairing<decltype(kind)>(system, Effect::has);
      if (found && key.empty()) key = Effect::setting_of(*found);
    });
    return key.empty() ? Effect::kOtherwise : key;
  }
  /// Impulses of the kinds of contact that have it.
  static std::int64_t work(const World& world) {
    std::int64_t sum = 0;
    each_kind([&](auto kind) {
      if (first_pairing<decltype(kind)>(world.system, Effect::has)) sum += world.counters.*decltype(kind)::kImpulses;
    });
    return sum;
  }
  static void switch_off(System& system) {
    each_kind([&](auto kind) {
      if (has_values<decltype(kind)>(system)) Effect::remove(decltype(kind)::of(system));
    });
  }
};

struct RestitutionSpeed : OnContacts<RestitutionSpeed> {
  static constexpr const char* kOtherwise = "every restitution_speed = 0";
  static bool has(const Pairing& one) { return one.contact.has_restitution_speed(); }
  static std::string setting_of(const Pairing& one) {
    return setting(one.key + ".restitution_speed", one.contact.restitution_speed, " mm/s");
  }
  static void remove(Contacts& contacts) {
    contacts.restitution_speed = 0;
    for (OwnContact& own : contacts.own) own.restitution_speed.reset();
  }
};

struct SpeciesContacts : OnContacts<SpeciesContacts> {
  static constexpr const char* kOtherwise = "all species alike";
  static bool has(const Pairing& one) { return one.own != OwnContact{}; }
  static std::string setting_of(const Pairing& one) {
    if (one.own.friction) return setting(one.key + ".friction", *one.own.friction);
    if (one.own.restitution) return setting(one.key + ".restitution", *one.own.restitution);
    return setting(one.key + ".restitution_speed", *one.own.restitution_speed, " mm/s");
  }
  static void remove(Contacts& contacts) { contacts.own = {}; }
};

struct RotationalNoise {
  static bool is_on(const System& system) { return system.has_rotational_noise(); }
  static std::string why(const System& system) {
    for (std::size_t number = 1; number < kMostSpecies && !(system.rotational_noise > 0); ++number) {
      if (system.has_species(number) && system.noise_of(number) > 0)
        return setting("plates." + species_name(number) + ".noise", system.noise_of(number), " rad/mm");
    }
    return setting("plates.noise", system.rotational_noise, " rad/mm");
  }
  static std::int64_t work(const World& world) { return world.counters.noise_kicks; }
  static void switch_off(System& system) {
    system.rotational_noise = 0;
    system.added_noise = {};
  }
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
  static bool is_on(const System& system) {
    bool any = false;
    each_kind([&](auto kind) { any |= Friction<decltype(kind)>::is_on(system); });
    return any;
  }
  static std::string why(const System& system) {
    std::string key;
    each_kind([&](auto kind) {
      using OfKind = Friction<decltype(kind)>;
      if (key.empty() && OfKind::is_on(system)) key = OfKind::why(system);
    });
    return key.empty() ? "every friction = 0" : key;
  }
  static std::int64_t work(const World& world) {
    std::int64_t sum = 0;
    each_kind([&](auto kind) {
      using OfKind = Friction<decltype(kind)>;
      if (OfKind::is_on(world.system)) sum += OfKind::work(world);
    });
    return sum;
  }
  static void switch_off(System& system) {
    each_kind([&](auto kind) { Friction<decltype(kind)>::switch_off(system); });
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
    line<Falling>("gravity", "rod_ticks", "Rods fall."),
    line<Vibration>("vibration", "periods", "The plates vibrate."),
    line<HorizontalVibration>("horizontal_vibration", "periods", "The plates vibrate in the plane too."),
    line<SecondVibrationOfPlates>("second_vibration", "periods", "The plates have a second vibration."),
    line<LidByItself>("lid_motion", "impulses", "The lid does not move with the base."),
    line<Inclination>("inclination", "rod_ticks", "Inclined plates: gravity has a part along them."),
    line<Tilt>("tilt", "rod_ticks", "Rods leave the plane and tilt out of it."),
    line<SeveralSpecies>("species", "rods", "Rods of other species beside the first."),
    line<Polydispersity>("polydispersity", "rods", "Rods of one species differ in size."),
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
    line<Friction<RodWall>>("side_wall_friction", "impulses", "Coulomb's friction between rod and side wall."),
    line<PostCollisions>("posts", "impulses", "Round posts that stand among the rods."),
    line<Friction<RodPost>>("post_friction", "impulses", "Coulomb's friction between rod and post."),
    line<RestitutionSpeed>("restitution_speed", "impulses", "Restitution falls with the speed of an impact."),
    line<SpeciesContacts>("species_contacts", "impulses", "Species have friction and restitution of their own."),
    line<RotationalNoise>("rotational_noise", "kicks", "Rough plates turn rods at random."),
    line<ImpactsAtInstant>("impacts_at_instant", "impulses", "Impacts take place at their own instant in a tick."),
};

}  // namespace

std::span<const Effect> all_effects() { return kEffects; }

}  // namespace shaken
