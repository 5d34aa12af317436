// One hash per scene, pinned: any change of the trajectory, down to the last bit, shows here. A change that is meant
// gets new hashes, a new physics version (sim/physics_version.h) and a line in CHANGELOG.md under "changes
// results".
#include <gtest/gtest.h>

#include "sim/simulation.h"

namespace shaken {
namespace {

struct Golden {
  const char* name;
  System system;
  Tick ticks;
  std::uint64_t hash;
};

System scene_of(double length, double side, int n_rods) {
  System system;
  system.rod.length = length;
  system.rod.n_beads = beads_for_pitch(length, system.rod.end_diameter, 0.3);
  system.box_side = side;
  system.n_rods = n_rods;
  return system;
}

/// A scene with so much of everything that little of the simulator is left out.
System mixed(Arena arena) {
  System system = scene_of(2.5, 14, 0);
  system.added = {AddedRods{{.length = 3.0, .mid_diameter = 0.9, .n_beads = 11, .profile = Profile::kPolar}, 8},
                  AddedRods{{.length = 0.8, .n_beads = 1}, 8}};
  system.walls = SideWalls{arena, 13.0, 3.0, {0.1, 0.3}};
  system.n_rods = arena == Arena::kSquare ? 22 : 14;
  system.start = Start::kRandom;
  return system;
}

TEST(GoldenHash, TrajectoriesAreWhatTheyWere) {
  std::vector<Golden> cases{
      {"dense, l = 4.5 mm", scene_of(4.5, 20, 120), 5000, 0x6d37e6237c1429f8},
      {"dilute, l = 2.5 mm, random start", scene_of(2.5, 20, 80), 10000, 0x2be0513754d8d449},
      {"spheres", scene_of(0.8, 10, 100), 10000, 0x3e2867eebde8c3eb},
      {"no whole period", scene_of(3.5, 15, 70), 5000, 0x5dd37aa346510b5f},
      {"several species in a square, rough plates", mixed(Arena::kSquare), 30000, 0xf347b02339560ed8},
      {"several species in a disc, impacts at their instant", mixed(Arena::kDisc), 30000, 0x9dfdbc90a683d4f2},
      {"several species in an annulus, Poisson's law, shuffled", mixed(Arena::kAnnulus), 30000, 0x5fc6427c01ce1186},
      {"impacts at their instant, Stronge's law, sticky and rough", scene_of(4.5, 20, 110), 5000, 0xe3865ee0884cfd4c},
      {"beads one by one", scene_of(2.5, 14, 60), 5000, 0x562fb18d67bb49aa},
      {"the smallest box", scene_of(2.5, 5.5, 8), 40000, 0x397aa841b294fade},
      {"rows at an angle", scene_of(3.5, 15, 70), 5000, 0x5c82de3eaf839572},
      {"compressed", scene_of(3.5, 15, 80), 5000, 0x65a05dd256fdf0c5},
      {"domains", scene_of(3.5, 18, 90), 5000, 0x8c7c153ef3dad8e5},
      {"a pair of defects", scene_of(3.5, 18, 90), 5000, 0x8a9e2297f8de8d92},
      {"restitution that falls with speed", scene_of(2.5, 14, 60), 10000, 0x7978c5d0918dacef},
      {"species with contacts of their own in a disc", mixed(Arena::kDisc), 30000, 0x89768fba3fa03079},
      {"several species in a stadium", mixed(Arena::kStadium), 30000, 0x6a114fe4fbb24be6},
      {"several species in a channel, impacts at their instant", mixed(Arena::kChannel), 30000, 0xe302673a31a09784},
      {"plates that vibrate in the plane too", scene_of(3.5, 15, 70), 5000, 0xcaaff5f1cc8cf3b2},
      {"among posts, compressed", scene_of(2.5, 18, 60), 20000, 0xda28e612c63c018b},
      {"several species among posts in a disc, impacts at their instant", mixed(Arena::kDisc), 30000,
       0x48307e86766668d0},
      {"rods that differ in length and taper, compressed", scene_of(3.5, 18, 80), 10000, 0x6e71f0697403ca28},
      {"several species in an ellipse", mixed(Arena::kEllipse), 30000, 0x606a561f75ac60b6},
      {"several species in a wedge, impacts at their instant", mixed(Arena::kWedge), 30000, 0x2417e5970633078f},
  };
  cases[1].system.start = Start::kRandom;
  cases[2].system.rod = {.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1};
  cases[3].system.frequency = 173.3;
  cases[4].system.rotational_noise = 0.05;
  cases[5].system.impacts = ImpactTime::kAtInstant;
  cases[6].system.law = ImpulseLaw::kPoisson;
  cases[6].system.order = ContactOrder::kShuffled;
  cases[7].system.impacts = ImpactTime::kAtInstant;
  cases[7].system.law = ImpulseLaw::kEnergetic;
  cases[7].system.rod_rod.friction = cases[7].system.rod_base.friction = 0.5;
  cases[7].system.rotational_noise = 0.02;
  cases[8].system.rod = {.length = 2.5, .bead_diameters{0.9, 0.8, 0.6, 0.4, 0.5, 0.7, 0.5, 0.3}};
  cases[10].system.start_angle = 30;
  cases[11].system.start = Start::kCompressed;
  cases[12].system.start = Start::kPolydomain;
  cases[13].system.start = Start::kDefectPair;
  cases[13].system.start_separation = 8;
  cases[13].system.start_angle = 90;
  cases[14].system.rod_rod.restitution_speed = cases[14].system.rod_lid.restitution_speed = 20;
  cases[14].system.rod_base.restitution_speed = 60;
  cases[15].system.rod_rod.own[Contacts::place(0, 1)] = {0.3, 0.8, {}};
  cases[15].system.rod_base.own[Contacts::place(0, 2)] = {0.2, {}, 40.0};
  cases[15].system.walls->contact.own[Contacts::place(0, 1)].restitution = 0.7;
  cases[16].system.n_rods = 8;
  cases[16].system.walls->size = 8;
  cases[16].system.walls->length = 5;
  cases[17].system.impacts = ImpactTime::kAtInstant;
  cases[18].system.horizontal_amplitude = 0.06;
  cases[18].system.horizontal_phase = 70;
  cases[18].system.horizontal_angle = 30;
  cases[19].system.start = Start::kCompressed;
  cases[19].system.posts = Posts{.diameter = 2, .columns = 3, .rows = 3, .contact = {0.1, 0.5}};
  cases[20].system.impacts = ImpactTime::kAtInstant;
  cases[20].system.posts = Posts{.diameter = 1.3, .places = {{5, 6}, {6.3, 6}, {7, 10}, {10, 7}}};
  cases[20].system.n_rods = 10;
  cases[21].system.rod.spread = {.length = 0.1, .end_diameter = 0.2};
  cases[21].system.start = Start::kCompressed;
  cases[22].system.n_rods = cases[23].system.n_rods = 8;
  cases[22].system.walls->size = cases[23].system.walls->size = 9;
  cases[22].system.walls->length = cases[23].system.walls->length = 13;
  cases[23].system.walls->narrow = 3;
  cases[23].system.impacts = ImpactTime::kAtInstant;
  for (const Golden& golden : cases) {
    auto simulation = Simulation::start(golden.system);
    ASSERT_TRUE(static_cast<bool>(simulation)) << simulation.error().message;
    const auto trouble = simulation->advance_to(golden.ticks);
    ASSERT_FALSE(trouble.has_value()) << trouble->what;
    const Counters& did = simulation->world().counters;
    EXPECT_GT(did.impulses_rod_rod, 20) << golden.name;
    if (golden.system.walls) {
      EXPECT_GT(did.impulses_rod_wall, 10) << golden.name;
    }
    if (golden.system.posts) {
      EXPECT_GT(did.impulses_rod_post, 10) << golden.name;
    }
    EXPECT_EQ(simulation->state_hash(), golden.hash) << golden.name << std::hex << ": 0x" << simulation->state_hash();
  }
}

}  // namespace
}  // namespace shaken
