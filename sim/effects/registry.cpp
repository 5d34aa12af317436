#include "sim/effects/registry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

namespace shaken {
namespace {

std::int64_t n_rods(const World& world) { return static_cast<std::int64_t>(world.rods.size()); }

// --- what every rod does

struct Falling {
  static bool is_on(const System& system) { return system.gravity > 0; }
  static std::int64_t work(const World& world) { return world.tick * n_rods(world); }
  static void switch_off(System& system) { system.gravity = 0; }
};

struct Vibration {
  static bool is_on(const System& system) { return system.amplitude > 0 && system.frequency > 0; }
  static std::int64_t work(const World& world) {
    const double time = static_cast<double>(world.tick) * world.system.dt;
    return static_cast<std::int64_t>(std::floor(time * world.system.frequency));
  }
  static void switch_off(System& system) { system.amplitude = 0; }
};

struct HorizontalVibration {
  static bool is_on(const System& system) { return system.has_horizontal_vibration(); }
  static std::int64_t work(const World& world) { return Vibration::work(world); }
  static void switch_off(System& system) { system.horizontal_amplitude = 0; }
};

struct SecondVibrationOfPlates {
  static bool is_on(const System& system) { return system.has_second_vibration(); }
  static std::int64_t work(const World& world) {
    const double time = static_cast<double>(world.tick) * world.system.dt;
    return static_cast<std::int64_t>(std::floor(time * world.system.second->frequency));
  }
  static void switch_off(System& system) { system.second.reset(); }
};

struct LidByItself {
  static bool is_on(const System& system) { return system.has_lid_motion(); }
  static std::int64_t work(const World& world) { return world.counters.impulses_rod_lid; }
  static void switch_off(System& system) { system.lid_motion.reset(); }
};

struct Inclination {
  static bool is_on(const System& system) { return system.has_inclination(); }
  static std::int64_t work(const World& world) { return world.tick * n_rods(world); }
  static void switch_off(System& system) { system.inclination = 0; }
};

struct Tilt {
  static bool is_on(const System& system) { return !system.is_planar(); }
  static std::int64_t work(const World& world) { return world.tick * n_rods(world); }
  static void switch_off(System& system) {
    system.base = system.lid = false;
    system.gravity = 0;
  }
};

struct SeveralSpecies {
  static bool is_on(const System& system) { return system.added[0] || system.added[1]; }
  static std::int64_t work(const World& world) {
    return n_rods(world) - static_cast<std::int64_t>(world.system.n_rods);
  }
  static void switch_off(System& system) { system.added = {}; }
};

struct Polydispersity {
  static bool is_on(const System& system) {
    const auto differ = [](const RodShape& rod) { return rod.spread.length > 0 || rod.spread.end_diameter > 0; };
    return differ(system.rod) || std::ranges::any_of(system.added, [&](auto& a) { return a && differ(a->rod); });
  }
  static std::int64_t work(const World& world) { return n_rods(world); }
  static void switch_off(System& system) {
    system.rod.spread = {};
    for (auto& added : system.added) {
      if (added) added->rod.spread = {};
    }
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
  static constexpr auto kImpulses = &Counters::impulses_rod_rod;
  static constexpr bool kIsOfTwoRods = true;
  static bool is_there(const System&) { return true; }
  static auto& of(auto& system) { return system.rod_rod; }
};
struct RodBase {
  static constexpr auto kImpulses = &Counters::impulses_rod_base;
  static constexpr bool kIsOfTwoRods = false;
  static bool is_there(const System& system) { return system.base; }
  static void remove(System& system) { system.base = false; }
  static auto& of(auto& system) { return system.rod_base; }
};
struct RodLid {
  static constexpr auto kImpulses = &Counters::impulses_rod_lid;
  static constexpr bool kIsOfTwoRods = false;
  static bool is_there(const System& system) { return system.lid; }
  static void remove(System& system) { system.lid = false; }
  static auto& of(auto& system) { return system.rod_lid; }
};
struct RodWall {
  static constexpr auto kImpulses = &Counters::impulses_rod_wall;
  static constexpr bool kIsOfTwoRods = false;
  static bool is_there(const System& system) { return system.walls.has_value(); }
  static void remove(System& system) { system.walls.reset(); }
  static auto& of(auto& system) { return system.walls->contact; }
};

struct RodPost {
  static constexpr auto kImpulses = &Counters::impulses_rod_post;
  static constexpr bool kIsOfTwoRods = false;
  static bool is_there(const System& system) { return system.posts.has_value(); }
  static void remove(System& system) { system.posts.reset(); }
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
  ContactParameters contact;
  OwnContact own;  ///< what is not as for the first species
};

/// All of a kind, that of the first species in front; none where one of its bodies is missing.
template <class Contact>
std::vector<Pairing> pairings(const System& system) {
  if (!Contact::is_there(system)) return {};
  const Contacts& contacts = Contact::of(system);
  std::vector<Pairing> all{{contacts, {}}};
  for (std::size_t b = 1; b < kMostSpecies; ++b) {
    for (std::size_t a = 0; a <= (Contact::kIsOfTwoRods ? b : 0); ++a) {
      if (!system.has_species(a) || !system.has_species(b)) continue;
      all.push_back({contacts.of(a, b), contacts.own[Contacts::place(a, b)]});
    }
  }
  return all;
}

/// Whether `asks` holds for one of those.
template <class Contact, class Asks>
bool any_pairing(const System& system, const Asks& asks) {
  return std::ranges::any_of(pairings<Contact>(system), asks);
}

struct RodCollisions {
  static bool is_on(const System& system) { return system.n_all_rods() > 1; }
  static std::int64_t work(const World& world) { return world.counters.impulses_rod_rod; }
  static constexpr void (*switch_off)(System&) = nullptr;
};

/// Collisions of rods with what a scene may have or not.
template <class Contact>
struct Collisions {
  static bool is_on(const System& system) { return Contact::is_there(system); }
  static std::int64_t work(const World& world) { return world.counters.*Contact::kImpulses; }
  static void switch_off(System& system) { Contact::remove(system); }
};

/// A value of contacts that is on where any pair of materials has it above 0.
template <class Contact, auto value, auto own_value>
struct ContactValue {
  static bool is_on(const System& system) {
    return any_pairing<Contact>(system, [](const Pairing& one) { return one.contact.*value > 0; });
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
using Friction = ContactValue<Contact, &ContactParameters::friction, &OwnContact::friction>;
template <class Contact>
using Restitution = ContactValue<Contact, &ContactParameters::restitution, &OwnContact::restitution>;

/// An effect on contacts of every kind, which is on where any pair of materials `has` it.
template <class Effect>
struct OnContacts {
  static bool is_on(const System& system) {
    bool any = false;
    each_kind([&](auto kind) { any |= any_pairing<decltype(kind)>(system, Effect::has); });
    return any;
  }
  /// Impulses of the kinds of contact that have it.
  static std::int64_t work(const World& world) {
    std::int64_t sum = 0;
    each_kind([&](auto kind) {
      if (any_pairing<decltype(kind)>(world.system, Effect::has)) sum += world.counters.*decltype(kind)::kImpulses;
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
  static bool has(const Pairing& one) { return one.contact.has_restitution_speed(); }
  static void remove(Contacts& contacts) {
    contacts.restitution_speed = 0;
    for (OwnContact& own : contacts.own) own.restitution_speed.reset();
  }
};

struct SpeciesContacts : OnContacts<SpeciesContacts> {
  static bool has(const Pairing& one) { return one.own != OwnContact{}; }
  static void remove(Contacts& contacts) { contacts.own = {}; }
};

struct RotationalNoise {
  static bool is_on(const System& system) { return system.has_rotational_noise(); }
  static std::int64_t work(const World& world) { return world.counters.noise_kicks; }
  static void switch_off(System& system) {
    system.rotational_noise = 0;
    system.added_noise = {};
  }
};

struct ImpactsAtInstant {
  static bool is_on(const System& system) { return system.has_impacts_at_instant(); }
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
constexpr Effect line(std::string_view name, std::string_view unit, std::string_view keys, std::string_view what) {
  return {name,
          what,
          [](const System& system) { return E::is_on(system); },
          keys,
          [](const World& world) { return E::is_on(world.system) ? E::work(world) : std::int64_t{0}; },
          unit,
          E::switch_off};
}

constexpr std::array kEffects{
    line<Falling>("gravity", "rod_ticks", "gravity", "Rods fall."),
    line<Vibration>("vibration", "periods", "plates.amplitude", "The plates vibrate."),
    line<HorizontalVibration>("horizontal_vibration", "periods", "plates.horizontal_amplitude",
                              "The plates vibrate in the plane too."),
    line<SecondVibrationOfPlates>("second_vibration", "periods", "plates.second.amplitude",
                                  "The plates have a second vibration."),
    line<LidByItself>("lid_motion", "impulses", "plates.lid_motion.amplitude", "The lid does not move with the base."),
    line<Inclination>("inclination", "rod_ticks", "plates.inclination",
                      "Inclined plates: gravity has a part along them."),
    line<Tilt>("tilt", "rod_ticks", "plates.base plates.lid gravity", "Rods leave the plane and tilt out of it."),
    line<SeveralSpecies>("species", "rods", "rods_*.count", "Rods of other species beside the first."),
    line<Polydispersity>("polydispersity", "rods", "rods*.length_spread rods*.end_diameter_spread",
                         "Rods of one species differ in size."),
    line<Taper>("taper", "rods", "rods*.bead_diameters rods*.end_diameter rods*.end_diameter_spread",
                "Rods are thinner at their ends than in the middle, or thicker."),
    line<Spin>("spin", "impulses", "contacts.*.friction walls*.friction posts*.friction",
               "Rods spin about their own axes."),
    line<RodCollisions>("rod_rod_collisions", "impulses", "rods.count", "Rods collide with each other."),
    line<Friction<RodRod>>("rod_rod_friction", "impulses", "contacts.rod_rod*.friction",
                           "Coulomb's friction between two rods."),
    line<Restitution<RodRod>>("rod_rod_restitution", "impulses", "contacts.rod_rod*.restitution",
                              "Rods bounce off each other."),
    line<Collisions<RodBase>>("rod_base_collisions", "impulses", "plates.base", "Rods collide with the base."),
    line<Friction<RodBase>>("rod_base_friction", "impulses", "contacts.rod_base*.friction",
                            "Coulomb's friction between rod and base."),
    line<Restitution<RodBase>>("rod_base_restitution", "impulses", "contacts.rod_base*.restitution",
                               "Rods bounce off the base."),
    line<Collisions<RodLid>>("rod_lid_collisions", "impulses", "plates.lid", "Rods collide with the lid."),
    line<Friction<RodLid>>("rod_lid_friction", "impulses", "contacts.rod_lid*.friction",
                           "Coulomb's friction between rod and lid."),
    line<Restitution<RodLid>>("rod_lid_restitution", "impulses", "contacts.rod_lid*.restitution",
                              "Rods bounce off the lid."),
    line<Collisions<RodWall>>("side_walls", "impulses", "walls.size", "Walls round an arena."),
    line<Friction<RodWall>>("side_wall_friction", "impulses", "walls*.friction",
                            "Coulomb's friction between rod and side wall."),
    line<Collisions<RodPost>>("posts", "impulses", "posts.diameter", "Round posts that stand among the rods."),
    line<Friction<RodPost>>("post_friction", "impulses", "posts*.friction", "Coulomb's friction between rod and post."),
    line<RestitutionSpeed>("restitution_speed", "impulses", "*.restitution_speed",
                           "Restitution falls with the speed of an impact."),
    line<SpeciesContacts>("species_contacts", "impulses",
                          "*.rods*.friction *.rods*.restitution *.rods*.restitution_speed",
                          "Species have friction and restitution of their own."),
    line<RotationalNoise>("rotational_noise", "kicks", "plates*.noise", "Rough plates turn rods at random."),
    line<ImpactsAtInstant>("impacts_at_instant", "impulses", "time.impacts",
                           "Impacts take place at their own instant in a tick."),
};

}  // namespace

std::span<const Effect> all_effects() { return kEffects; }

}  // namespace shaken
