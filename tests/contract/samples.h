#pragma once

#include "proto/codec.h"

/// One message of each type with every field set to something that can be told from the others.
namespace shaken::proto::samples {

template <class T>
T make();

template <>
inline status_t make() {
  status_t m;
  m.utime = 1700000000123456;
  m.sequence = 41;
  m.host = "lab-pc";
  m.pid = 4711;
  m.version = "0.1.0";
  m.root = "/srv/shaken";
  m.uptime_s = 12.5;
  m.n_slots = 2;
  m.n_queued = 3;
  m.n_running = 4;
  m.n_done = 5;
  m.n_failed = 6;
  m.n_cancelled = 7;
  return m;
}

template <>
inline job_t make() {
  job_t m;
  m.utime = 1700000000123456;
  m.sequence = 42;
  m.job_id = "0123456789abcdef";
  m.sweep_id = "s1";
  m.state = "failed";
  m.reason = "disk full";
  m.label = "rods.length=2.5 rods.area_fraction=0.6";
  m.attempt = 2;
  m.progress = 0.25;
  m.sim_time_s = 1.5;
  m.sim_time_total_s = 6;
  m.sim_rate = 0.01;
  m.eta_s = 450;
  return m;
}

template <>
inline observables_t make() {
  observables_t m;
  m.utime = 1700000000123456;
  m.sequence = 43;
  m.job_id = "0123456789abcdef";
  m.sim_time_s = 1.5;
  m.sim_time_total_s = 6;
  m.n_rods = 2109;
  m.order = 0.875;
  m.order_running_mean = 0.75;
  m.director_rad = -0.5;
  m.rms_speed_xy_mm_s = 3;
  m.rms_speed_z_mm_s = 4;
  m.rms_n_z = 0.0625;
  m.kinetic_energy_uJ = 5;
  m.max_overlap_mm = 0.001;
  m.collisions_rod_rod = INT64_C(5000000000);
  m.collisions_rod_base = 8;
  m.collisions_rod_lid = 9;
  m.sim_rate = 0.01;
  m.eta_s = -1;
  return m;
}

template <>
inline frame_static_t make() {
  frame_static_t m;
  m.utime = 1700000000123456;
  m.sequence = 44;
  m.job_id = "0123456789abcdef";
  m.sim_time_s = 1.5;
  m.n_rods = 2109;
  m.box_x_mm = 83.73;
  m.box_y_mm = 41.5;
  m.gap_mm = 1.2;
  m.n_species = 2;
  m.species_beads = {3, 1};
  m.n_beads = 4;
  m.bead_offset_mm = {-2, 0, 2, 0};
  m.bead_radius_mm = {0.2, 0.4, 0.2, 0.5};
  m.n_rod_species = 5;
  m.rod_species = {0, 1, 0, 0, 1};
  m.arena = "annulus";
  m.arena_size_mm = 70;
  m.arena_inner_mm = 20;
  m.label = "rods.length=4.5";
  return m;
}

template <>
inline frame_t make() {
  frame_t m;
  m.utime = 1700000000123456;
  m.sequence = 45;
  m.job_id = "0123456789abcdef";
  m.sim_time_s = 1.5;
  m.tick = 375000;
  m.box_x_mm = 83.73;
  m.box_y_mm = 41.5;
  m.order = 0.5;
  m.director_rad = 0.25;
  m.n_rods = 3;
  m.chunk = 0;
  m.n_chunks = 1;
  m.first_rod = 0;
  m.n_chunk_rods = 3;
  m.x = {-32768, 0, 32767};
  m.y = {1, -2, 3};
  m.heading = {-32768, 5, 32767};
  m.n_z = {-32767, 0, 32767};
  return m;
}

template <>
inline defects_t make() {
  defects_t m;
  m.utime = 1700000000123456;
  m.sequence = 46;
  m.job_id = "0123456789abcdef";
  m.sim_time_s = 1.5;
  m.smoothing_mm = 2.25;
  m.n_defects = 2;
  m.x_mm = {1, 2};
  m.y_mm = {3, 4};
  m.charge = {0.5, -0.5};
  m.direction_rad = {0.1, -0.2};
  return m;
}

template <>
inline posts_t make() {
  posts_t m;
  m.utime = 1700000000123456;
  m.sequence = 47;
  m.job_id = "0123456789abcdef";
  m.sim_time_s = 1.5;
  m.diameter_mm = 4;
  m.n_posts = 2;
  m.x_mm = {1, 2};
  m.y_mm = {3, 4};
  return m;
}

template <>
inline sizes_t make() {
  sizes_t m;
  m.utime = 1700000000123456;
  m.sequence = 48;
  m.job_id = "0123456789abcdef";
  m.sim_time_s = 1.5;
  m.n_sizes = 3;
  m.species = {0, 0, 1};
  return m;
}

}  // namespace shaken::proto::samples
