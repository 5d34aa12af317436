#pragma once

#include "tests/support/short_rods.h"

namespace shaken::test {

/// A scene in which every effect is on and all kinds of contact occur within 2,000 ticks.
inline System everything_on() {
  System system = short_rods(57, 19);
  system.added[0] = AddedRods{{.length = 2.5, .n_beads = 9, .profile = Profile::kPolar}, 25};
  system.added[1] = AddedRods{{.length = 0.8, .n_beads = 1}, 10};
  system.rod.spread = {.length = 0.05, .end_diameter = 0.1};
  system.added[1]->rod.spread.length = 0.1;
  system.walls = SideWalls{Arena::kSquare, 18.0, 1.0, {0.1, 0.3}};
  system.posts = Posts{.diameter = 1.2, .columns = 2, .rows = 2, .contact = {0.1, 0.3}};
  system.posts->contact.own[Contacts::place(0, 2)].friction = 0.4;
  system.walls->contact.own[Contacts::place(0, 1)].restitution = 0.6;
  system.rod_rod.own[Contacts::place(1, 1)].friction = 0.2;
  system.rod_base.own[Contacts::place(0, 1)] = {0.1, 0.5, {}};
  system.rod_lid.own[Contacts::place(0, 2)].restitution_speed = 20.0;
  system.rod_rod.restitution_speed = 50;
  system.horizontal_amplitude = 0.02;
  system.second = SecondVibration{0.01, 340.0, 50.0};
  system.lid_motion = LidMotion{0.03, 100.0};
  system.inclination = 2;
  system.rotational_noise = 0.05;
  system.added_noise = {0.0, 0.1};
  system.impacts = ImpactTime::kAtInstant;
  return system;
}

}  // namespace shaken::test
