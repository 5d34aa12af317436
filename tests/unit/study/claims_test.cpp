// SPDX-License-Identifier: MIT
// Every verdict on the paper, held against made-up runs: a row for each thing that it can say.
#include "study/claims.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "study/figures.h"
#include "tests/unit/study/made_up_run.h"

namespace shaken::study {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

constexpr Verdict kAgrees = Verdict::kAgrees, kPartly = Verdict::kPartly, kDisagrees = Verdict::kDisagrees,
                  kOpen = Verdict::kUnresolved;

struct Case {
  std::string claim;
  Verdict verdict;
  std::string because;  ///< what sets this case apart
  MadeUpSets runs;
};

// ---- what several claims are told alike ----

/// One sweep with one run for each point: made(at, value).
template <class Make>
MadeUpSets sweep(const std::string& set, const std::vector<std::pair<double, double>>& points, Make made) {
  std::vector<MadeUp> runs;
  for (const auto& [at, value] : points) runs.push_back(made(at, value));
  return {{set, runs}};
}

/// S against packing for rods of a length.
MadeUpSets orders(double length, const std::vector<std::pair<double, double>>& points, double sem = 0.01) {
  return sweep("phases", points, [&](double phi, double s) { return MadeUp(length, phi).order(s, sem); });
}

/// A scalar against packing in the phase diagram.
MadeUpSets scalars(double length, const std::string& name, const std::vector<std::pair<double, double>>& points,
                   double sem) {
  return sweep("phases", points,
               [&](double phi, double value) { return MadeUp(length, phi).order(0.5).scalar(name, value, sem); });
}

MadeUpSets operator+(MadeUpSets a, const MadeUpSets& b) {
  for (const auto& more : b) {
    const auto same = std::find_if(a.begin(), a.end(), [&](const auto& set) { return set.first == more.first; });
    if (same == a.end()) {
      a.push_back(more);
    } else {
      same->second.insert(same->second.end(), more.second.begin(), more.second.end());
    }
  }
  return a;
}

/// A layered run: theta_m [degrees] between peaks, with a wavelength [mm].
MadeUp layered_run(double length, double phi, double theta, double wavelength = 15, double sem = 0.2) {
  return MadeUp(length, phi)
      .order(0.9)
      .scalar("dip", 0.6, 0.02)
      .scalar("theta_m_deg", theta, sem)
      .scalar("layer_order", 0.30, 0.01)
      .scalar("bragg_peak", 0.02, 0.001)
      .scalar("wavelength_mm", wavelength, 5 * sem);
}
/// One that has none: one peak, as sure as `dip_sem` says.
MadeUp unlayered_run(double length, double phi, double dip_sem = 0.005) {
  return MadeUp(length, phi)
      .order(0.9)
      .scalar("dip", 1.0, dip_sem)
      .scalar("theta_m_deg", NAN, NAN)
      .scalar("layer_order", 0.10, 0.01)
      .scalar("bragg_peak", 0.02, 0.001);
}

/// Layers along a series: {value of the key, theta_m}.
MadeUpSets angles(const std::string& key, const std::vector<std::pair<double, double>>& points, double sem = 0.2) {
  return sweep("layers", points, [&](double at, double theta) {
    return key == "packing"  ? layered_run(4.5, at, theta, 15, sem)
           : key == "length" ? layered_run(at, 0.85, theta, 15, sem)
                             : layered_run(4.0, 0.85, theta, 15, sem).end(at);
  });
}
/// The same of wavelengths; their error is five times `sem`.
MadeUpSets wavelengths(const std::string& key, const std::vector<std::pair<double, double>>& points, double sem = 0.1) {
  return sweep("layers", points, [&](double at, double wavelength) {
    return key == "packing"  ? layered_run(4.5, at, 10, wavelength, sem)
           : key == "length" ? layered_run(at, 0.85, 10, wavelength, sem)
                             : layered_run(4.0, 0.85, 10, wavelength, sem).end(at);
  });
}

/// P[S] with bumps at these of a hundred places, and noise from bin to bin.
std::vector<double> bumps(std::initializer_list<double> centres) {
  std::vector<double> density(100);
  for (std::size_t k = 0; k < density.size(); ++k) {
    for (const double centre : centres) density[k] += std::exp(-std::pow((static_cast<double>(k) - centre) / 6, 2));
    density[k] *= k % 2 == 0 ? 1.2 : 0.8;
  }
  return density;
}
MadeUpSets pdf(std::initializer_list<double> centres, double n_effective) {
  return {{"phases",
           {MadeUp(4.5, 0.65)
                .order(0.6)
                .number(Json::json_pointer("/order/n_effective"), n_effective)
                .array("/order/pdf/density", bumps(centres))}}};
}

/// S(t) that begins at `first`.
MadeUp started(double first) { return MadeUp(4.5, 0.65).order(0.6).array("/order/order", {first, 0.7, 0.6, 0.6}); }

/// Disorder or order at 0.45 in two boxes.
MadeUpSets dilute(double s_small, double s_large, double g2, double sem) {
  return {{"phases", {MadeUp(4.5, 0.45).box(33.5).order(s_small, sem).level("/g2/g2", g2, 0.01)}},
          {"size", {MadeUp(4.5, 0.45).box(67).order(s_large, sem).level("/g2/g2", g2, 0.01)}}};
}

/// The director at an angle [degrees] to the side.
MadeUpSets director(double s, double early, double late) {
  std::vector<double> time, angle;
  for (int k = 0; k < 40; ++k) {
    time.push_back(100 + k);
    angle.push_back((k < 20 ? early : late) * std::acos(-1.0) / 180);
  }
  return {{"layers", {MadeUp(3.5, 0.85).order(s).array("/order/time_s", time).array("/order/director_rad", angle)}}};
}

/// D against the strength of shaking, and how far rods go at rest [mm^2].
MadeUpSets shaken(double d_weak, double d_strong, double sem, double at_rest) {
  return {{"shaking",
           {MadeUp(2.5, 0.75).gamma(3).scalar("diffusion_mm2_s", d_weak, sem),
            MadeUp(2.5, 0.75).gamma(14).scalar("diffusion_mm2_s", d_strong, sem)}},
          {"rest", {MadeUp(2.5, 0.75).gamma(0).array("/msd/total_mm2", {0, at_rest / 2, at_rest})}}};
}

/// G2 at half a box.
MadeUpSets far(double short_dilute, double short_dense, double long_dense, double sem = 0.005, double side = 83.73) {
  return {{"phases",
           {MadeUp(2.5, 0.45).box(side).level("/g2/g2", short_dilute, sem),
            MadeUp(2.5, 0.85).box(side).level("/g2/g2", short_dense, sem),
            MadeUp(4.5, 0.80).box(side).level("/g2/g2", long_dense, sem)}}};
}

/// G2 or g along and across the director.
MadeUpSets cuts(const std::string& set, double phi, const std::string& what, double along, double across, double sem) {
  return {{set,
           {MadeUp(4.5, phi)
                .array("/pairs/cut/r_mm", {1, 3, 5, 7, 9, 11, 13, 15})
                .level("/pairs/cut/" + what + "_along", along, sem)
                .level("/pairs/cut/" + what + "_across", across, sem)}}};
}

MadeUpSets frank(double ratio, double sem, double chi2) {
  return {{"layers", {MadeUp(4.5, 0.75).scalar("frank_ratio", ratio, sem).scalar("frank_chi2", chi2)}}};
}

/// G2 across the director at 7.5 mm, half a wavelength away, and at 15 mm.
MadeUpSets wave(double trough, double crest, double sem) {
  return {{"layers",
           {layered_run(4.5, 0.80, 10)
                .array("/pairs/cut/r_mm", {0.5, 7.5, 15})
                .array("/pairs/cut/g2_across", {1, trough, crest})
                .array("/pairs/cut/g2_across_sem", {sem, sem, sem})}}};
}

/// v against tilt: fastest [mm/s] at n_z, and beyond 0.31.
MadeUpSets tilted(double fastest, double n_z, double beyond, double sem) {
  return {{"mechanism",
           {MadeUp(2.5, 0.60)
                .scalar("tilt_fastest_mm_s", fastest, sem)
                .scalar("tilt_fastest_n_z", n_z)
                .array("/tilt/folded/n_z", {0.18, 0.20, 0.32, 0.34})
                .array("/tilt/folded/v_along_mm_s", {fastest, fastest, beyond, beyond})
                .array("/tilt/folded/v_along_sem_mm_s", {sem, sem, sem, sem})}}};
}
/// v across the rod, alternating about zero or off it, at 40 tilts.
MadeUpSets sideways(double swing, double offset, double sem) {
  std::vector<double> v;
  for (int k = 0; k < 40; ++k) v.push_back(offset + (k % 2 == 0 ? swing : -swing));
  return {{"mechanism",
           {MadeUp(2.5, 0.60)
                .scalar("tilt_fastest_mm_s", -0.9, 0.01)
                .array("/tilt/v_across_mm_s", v)
                .array("/tilt/v_across_sem_mm_s", std::vector<double>(40, sem))}}};
}
MadeUpSets ways(double time_dilute, double time_dense, double length_dilute, double length_dense, double sem) {
  return {{"mechanism",
           {MadeUp(2.5, 0.65)
                .scalar("persistence_time_s", time_dilute, sem)
                .scalar("persistence_length_mm", length_dilute, sem),
            MadeUp(2.5, 0.85)
                .scalar("persistence_time_s", time_dense, sem)
                .scalar("persistence_length_mm", length_dense, sem)}}};
}

/// The paper's law of D, times a factor.
MadeUpSets law(double factor, double sem) {
  return sweep("phases", {{0.65, 0}, {0.75, 0}, {0.85, 0}}, [&](double phi, double) {
    const double d = factor * (1.7 + 480 * (phi - 0.64) * (phi - 0.64));
    return MadeUp(2.5, phi).scalar("diffusion_mm2_s", d, sem * d);
  });
}
/// D along the director at 0.70, 0.80, 0.85; across it 0.2 and `across_80`.
MadeUpSets along_director(double d70, double d80, double d85, double across_80, double sem) {
  const auto at = [&](double phi, double d, double across) {
    return MadeUp(4.5, phi).scalar("diffusion_along_mm2_s", d, sem).scalar("diffusion_across_mm2_s", across, sem / 10);
  };
  return {{"diffusion", {at(0.70, d70, 0.2), at(0.80, d80, across_80), at(0.85, d85, 0.05)}}};
}
MadeUpSets exponents(double length, const std::string& alpha, std::pair<double, double> shorts,
                     std::pair<double, double> longs, double sem) {
  return {
      {"phases",
       {MadeUp(length, 0.65).scalar(alpha + "_short", shorts.first, sem).scalar(alpha + "_long", longs.first, sem),
        MadeUp(length, 0.80).scalar(alpha + "_short", shorts.second, sem).scalar(alpha + "_long", longs.second, sem)}}};
}
/// Times [s] after which orientation and velocity are forgotten, dilute and dense.
MadeUpSets memory(double c2_dilute, double c2_dense, double c_v_dilute, double c_v_dense, double sem) {
  const auto at = [&](double phi, double c2, double c_v) {
    return MadeUp(2.5, phi).scalar("c2_decay_s", c2, sem).scalar("velocity_correlation_s", c_v, sem);
  };
  return {{"phases", {at(0.45, c2_dilute, c_v_dilute), at(0.85, c2_dense, c_v_dense)}}};
}
MadeUpSets defects(double plus_along, double sem) {
  return {{"defects",
           {MadeUp(3.0, 0.85)
                .scalar("defect_density_per_mm2", 0.01, 0.001)
                .scalar("lasting_defect_speed_plus_mm_s", 5, 0.2)
                .scalar("lasting_defect_speed_minus_mm_s", 4, 0.2)
                .scalar("lasting_defect_speed_plus_along_mm_s", plus_along, sem)}}};
}

// ---- the cases ----

std::vector<Case> cases() {
  return {
      // where rods order
      {"steady-state", kAgrees, "aligned, then steady", {{"phases", {started(1)}}}},
      {"steady-state", kDisagrees, "not aligned at first", {{"phases", {started(0.4)}}}},
      {"steady-state", kDisagrees, "still relaxing after the paper's 600 s", {{"phases", {started(1).relaxing()}}}},
      {"steady-state",
       kOpen,
       "too short to tell",
       {{"phases", {started(1).relaxing().number(Json::json_pointer("/sim_seconds"), 90)}}}},
      {"ordered", kAgrees, "0.9", orders(4.5, {{0.75, 0.91}})},
      {"ordered", kDisagrees, "disorder", orders(4.5, {{0.75, 0.3}})},
      {"ordered", kOpen, "an error larger than the tolerance", orders(4.5, {{0.75, 0.9}}, 0.2)},
      {"disordered", kAgrees, "S ~ 1/L", dilute(0.20, 0.10, 0.003, 0.01)},
      {"disordered", kDisagrees, "ordered in both boxes", dilute(0.8, 0.8, 0.6, 0.01)},
      {"disordered", kPartly, "little order, but the same in both", dilute(0.3, 0.3, 0.003, 0.01)},
      {"disordered", kOpen, "the boxes cannot be told apart", dilute(0.2, 0.1, 0.003, 0.08)},
      {"disordered", kOpen, "one box only", {dilute(0.2, 0.1, 0.003, 0.01).front()}},
      {"short", kAgrees, "no order", orders(2.5, {{0.65, 0.1}, {0.85, 0.2}}) + orders(3.0, {{0.85, 0.3}})},
      {"short", kDisagrees, "order in the paper's box", orders(2.5, {{0.85, 0.2}}) + orders(3.0, {{0.85, 0.8}})},
      {"short", kOpen, "order in a narrow box", {{"phases", {MadeUp(3.0, 0.85).box(33.5).order(0.8)}}}},
      {"short",
       kAgrees,
       "the wider box decides",
       {{"phases", {MadeUp(3.0, 0.85).box(33.5).order(0.8)}}, {"defects", {MadeUp(3.0, 0.85).order(0.2)}}}},
      {"transition", kAgrees, "longer, earlier",
       orders(3.5, {{0.45, 0.1}, {0.65, 0.6}}) + orders(4.5, {{0.45, 0.3}, {0.65, 0.9}})},
      {"transition", kDisagrees, "longer, later",
       orders(3.5, {{0.45, 0.3}, {0.65, 0.9}}) + orders(4.5, {{0.45, 0.1}, {0.65, 0.6}})},
      {"transition", kOpen, "one length does not pass",
       orders(3.5, {{0.45, 0.1}, {0.65, 0.4}}) + orders(4.5, {{0.45, 0.3}, {0.65, 0.9}})},
      {"transition", kOpen, "errors",
       orders(3.5, {{0.45, 0.1}, {0.65, 0.6}}, 0.2) + orders(4.5, {{0.45, 0.3}, {0.65, 0.9}}, 0.2)},
      {"saturates", kAgrees, "to 0.95", orders(4.5, {{0.45, 0.1}, {0.85, 0.95}})},
      {"saturates", kDisagrees, "falls", orders(4.5, {{0.45, 0.4}, {0.85, 0.1}})},
      {"saturates", kPartly, "rises to 0.6 only", orders(4.5, {{0.45, 0.1}, {0.85, 0.6}})},
      {"saturates", kOpen, "errors", orders(4.5, {{0.45, 0.5}, {0.85, 0.95}}, 0.3)},
      {"transition-size", kAgrees, "the larger box, later",
       orders(4.5, {{0.50, 0.1}, {0.60, 0.6}}) +
           MadeUpSets{{"size", {MadeUp(4.5, 0.50).box(33).order(0.4), MadeUp(4.5, 0.60).box(33).order(0.9)}}}},
      {"transition-size", kDisagrees, "the larger box, earlier",
       orders(4.5, {{0.50, 0.4}, {0.60, 0.9}}) +
           MadeUpSets{{"size", {MadeUp(4.5, 0.50).box(33).order(0.1), MadeUp(4.5, 0.60).box(33).order(0.6)}}}},
      {"transition-size", kOpen, "one of them does not pass",
       orders(4.5, {{0.50, 0.6}, {0.60, 0.9}}) +
           MadeUpSets{{"size", {MadeUp(4.5, 0.50).box(33).order(0.4), MadeUp(4.5, 0.60).box(33).order(0.9)}}}},
      {"long-range", kDisagrees, "S falls fast",
       orders(4.5, {{0.70, 0.5}}) + MadeUpSets{{"size", {MadeUp(4.5, 0.70).box(17).order(0.9)}}}},
      {"long-range", kOpen, "the same in both boxes: a small power is not ruled out",
       orders(4.5, {{0.70, 0.87}}) + MadeUpSets{{"size", {MadeUp(4.5, 0.70).box(17).order(0.87)}}}},
      {"unimodal", kAgrees, "noise is no peak", pdf({60}, 200)},
      {"unimodal", kDisagrees, "two", pdf({30, 60}, 200)},
      {"unimodal", kOpen, "two from few samples", pdf({30, 60}, 10)},
      {"unimodal", kOpen, "one from few samples", pdf({60}, 10)},
      {"broadest", kAgrees, "at the transition",
       sweep("phases", {{0.50, 1}, {0.55, 9}, {0.60, 1}},
             [](double phi, double chi) {
               return MadeUp(4.5, phi).order(10 * (phi - 0.5)).scalar("susceptibility", chi, 0.1);
             })},
      {"broadest", kDisagrees, "elsewhere",
       sweep("phases", {{0.50, 1}, {0.55, 1}, {0.85, 9}},
             [](double phi, double chi) {
               return MadeUp(4.5, phi).order(phi < 0.52 ? 0.1 : 0.9).scalar("susceptibility", chi, 0.1);
             })},
      {"broadest", kOpen, "no transition is passed",
       sweep("phases", {{0.50, 1}, {0.55, 9}},
             [](double phi, double chi) { return MadeUp(4.5, phi).order(0.1).scalar("susceptibility", chi, 0.1); })},
      {"oblique", kAgrees, "30 degrees", director(0.85, 30, 31)},
      {"oblique", kDisagrees, "no order", director(0.2, 30, 31)},
      {"oblique", kOpen, "along the start", director(0.85, 2, 2)},
      {"oblique", kOpen, "it turns", director(0.85, 12, 40)},
      {"activity", kAgrees, "more shaking, more motion", shaken(0.1, 6, 0.1, 1e-6)},
      {"activity", kDisagrees, "the other way round", shaken(6, 0.1, 0.1, 3)},
      {"activity", kPartly, "it moves at rest", shaken(0.1, 6, 0.1, 3)},
      {"activity", kOpen, "half of it", {shaken(0.1, 6, 0.1, 1e-6).front()}},
      {"activity", kOpen, "errors", shaken(5, 6, 2, 1e-6)},

      // correlations in space
      {"g2", kAgrees, "to 0, and a plateau", far(0.00, 0.01, 0.8)},
      {"g2", kPartly, "not to 0 when dense", far(0.00, 0.28, 0.8)},
      {"g2", kDisagrees, "the other way round", far(0.3, 0.3, 0.0)},
      {"g2", kOpen, "a narrow box", far(0.00, 0.28, 0.8, 0.005, 33.5)},
      {"g2", kOpen, "errors", far(0.0, 0.02, 0.8, 0.05)},
      {"isotropic", kAgrees, "the same both ways", cuts("size", 0.45, "g2", 0.10, 0.10, 0.005)},
      {"isotropic", kDisagrees, "not the same", cuts("size", 0.45, "g2", 0.40, 0.10, 0.005)},
      {"isotropic", kOpen, "errors", cuts("size", 0.45, "g2", 0.10, 0.10, 0.1)},
      {"anisotropy", kAgrees, "more along", cuts("layers", 0.75, "g2", 0.87, 0.78, 0.005)},
      {"anisotropy", kDisagrees, "more across", cuts("layers", 0.75, "g2", 0.78, 0.87, 0.005)},
      {"anisotropy", kOpen, "errors", cuts("layers", 0.75, "g2", 0.87, 0.78, 0.1)},
      {"g-flattens", kAgrees, "uneven across", cuts("layers", 0.75, "g", 1.0, 1.3, 0.01)},
      {"g-flattens", kDisagrees, "uneven along", cuts("layers", 0.75, "g", 1.3, 1.0, 0.01)},
      {"g-flattens", kOpen, "errors", cuts("layers", 0.75, "g", 1.0, 1.1, 0.1)},
      {"splay-bend", kAgrees, "splay costs more", frank(0.5, 0.1, 1.1)},
      {"splay-bend", kDisagrees, "bend costs more", frank(40, 10, 1.1)},
      {"splay-bend", kOpen, "errors", frank(2, 1, 1.1)},
      {"splay-bend", kOpen, "the law does not hold", frank(40, 10, 30)},

      // layers
      {"layers",
       kAgrees,
       "from 0.80 on",
       {{"layers", {unlayered_run(4.5, 0.75), layered_run(4.5, 0.80, 9), layered_run(4.5, 0.85, 11)}}}},
      {"layers",
       kPartly,
       "before 0.80 too",
       {{"layers", {layered_run(4.5, 0.75, 8), layered_run(4.5, 0.80, 9), layered_run(4.5, 0.85, 11)}}}},
      {"layers",
       kDisagrees,
       "before it only, and too steep",
       {{"layers", {layered_run(4.5, 0.75, 8), unlayered_run(4.5, 0.80), layered_run(4.5, 0.85, 25)}}}},
      {"layers",
       kOpen,
       "a dip may hide in the noise",
       {{"layers", {unlayered_run(4.5, 0.75, 0.1), layered_run(4.5, 0.80, 9), layered_run(4.5, 0.85, 11)}}}},
      {"g2-oscillates", kAgrees, "a crest a wavelength away", wave(0.6, 0.8, 0.01)},
      {"g2-oscillates", kDisagrees, "a trough there", wave(0.8, 0.6, 0.01)},
      {"g2-oscillates", kOpen, "errors", wave(0.6, 0.8, 0.3)},
      {"gap",
       kAgrees,
       "one peak and less order of layers",
       {{"layers", {layered_run(4.5, 0.80, 9)}},
        {"gaps", {unlayered_run(4.5, 0.80).gap(1.4), unlayered_run(4.5, 0.80).gap(1.6)}}}},
      {"gap",
       kDisagrees,
       "as many layers",
       {{"layers", {layered_run(4.5, 0.80, 9)}},
        {"gaps", {layered_run(4.5, 0.80, 9).gap(1.4).scalar("layer_order", 0.4, 0.01)}}}},
      {"gap",
       kOpen,
       "no second peak seen, but as much order of layers",
       {{"layers", {layered_run(4.5, 0.80, 9)}},
        {"gaps", {unlayered_run(4.5, 0.80, 0.1).gap(1.4).scalar("layer_order", 0.30, 0.02)}}}},
      {"crystal",
       kDisagrees,
       "layers, and no more of a crystal",
       {{"layers", {layered_run(4.5, 0.80, 9)}},
        {"gaps", {layered_run(4.5, 0.80, 9).gap(0.9).scalar("bragg_peak", 0.005, 0.0005)}}}},
      {"crystal",
       kOpen,
       "that of the start",
       {{"layers", {layered_run(4.5, 0.80, 9)}},
        {"gaps", {unlayered_run(4.5, 0.80).gap(0.9).scalar("bragg_peak", 0.3, 0.01)}}}},
      {"angle-packing", kAgrees, "", angles("packing", {{0.80, 9}, {0.85, 11}})},
      {"angle-packing", kDisagrees, "", angles("packing", {{0.80, 11}, {0.85, 9}})},
      {"angle-packing", kOpen, "errors", angles("packing", {{0.80, 8.5}, {0.85, 8.9}})},
      {"angle-packing", kAgrees, "one of two lengths can tell",
       angles("packing", {{0.80, 8.5}, {0.85, 8.9}}) +
           MadeUpSets{{"layers", {layered_run(4.0, 0.80, 10), layered_run(4.0, 0.85, 12)}}}},
      {"angle-length", kAgrees, "", angles("length", {{3.5, 13}, {4.0, 12}, {4.5, 9}})},
      {"angle-length", kDisagrees, "", angles("length", {{3.5, 9}, {4.0, 12}, {4.5, 13}})},
      {"angle-length", kOpen, "errors", angles("length", {{3.5, 13}, {4.0, 12}, {4.5, 12}}, 1)},
      {"angle-end", kAgrees, "", angles("end", {{0.4, 12}, {0.5, 10}, {0.6, 8}})},
      {"angle-end", kDisagrees, "", angles("end", {{0.4, 8}, {0.5, 10}, {0.6, 12}})},
      {"angle-end",
       kOpen,
       "blunt ends have no layers",
       {{"layers", {layered_run(4.0, 0.85, 12), unlayered_run(4.0, 0.85).end(0.6)}}}},
      {"peaks-end", kAgrees, "", angles("end", {{0.4, 12}, {0.6, 8}})},
      {"peaks-end",
       kPartly,
       "blunt ends have one",
       {{"layers", {layered_run(4.0, 0.85, 12), unlayered_run(4.0, 0.85).end(0.6)}}}},
      {"peaks-end",
       kDisagrees,
       "none has two",
       {{"layers", {unlayered_run(4.0, 0.85), unlayered_run(4.0, 0.85).end(0.6)}}}},
      {"peaks-end",
       kOpen,
       "a dip may hide in the noise",
       {{"layers", {layered_run(4.0, 0.85, 12), unlayered_run(4.0, 0.85, 0.1).end(0.6)}}}},
      {"wavelength-packing", kAgrees, "", wavelengths("packing", {{0.80, 16}, {0.85, 13}})},
      {"wavelength-packing", kDisagrees, "", wavelengths("packing", {{0.80, 13}, {0.85, 16}})},
      {"wavelength-packing", kOpen, "steps of L / n", wavelengths("packing", {{0.80, 14.5}, {0.85, 12.9}}, 0.3)},
      {"wavelength-length", kAgrees, "", wavelengths("length", {{3.5, 11}, {4.0, 14}, {4.5, 17}})},
      {"wavelength-length", kDisagrees, "", wavelengths("length", {{3.5, 17}, {4.0, 14}, {4.5, 11}})},
      {"wavelength-length", kOpen, "steps of L / n", wavelengths("length", {{3.5, 13.8}, {4.0, 15}, {4.5, 14}}, 0.3)},
      {"wavelength-end", kAgrees, "", wavelengths("end", {{0.4, 11}, {0.6, 17}})},
      {"wavelength-end", kDisagrees, "", wavelengths("end", {{0.4, 17}, {0.6, 11}})},
      {"wavelength-end",
       kOpen,
       "layers at one of two",
       {{"layers", {layered_run(4.0, 0.85, 12), unlayered_run(4.0, 0.85).end(0.6)}}}},
      {"larger-box",
       kAgrees,
       "",
       {{"layers", {layered_run(4.0, 0.85, 12, 15, 0.1)}}, {"large", {layered_run(4.0, 0.85, 11, 18, 0.1).box(167)}}}},
      {"larger-box",
       kPartly,
       "a wider wave, as steep",
       {{"layers", {layered_run(4.0, 0.85, 11, 15, 0.1)}}, {"large", {layered_run(4.0, 0.85, 12, 18, 0.1).box(167)}}}},
      {"larger-box",
       kDisagrees,
       "",
       {{"layers", {layered_run(4.0, 0.85, 11, 18, 0.1)}}, {"large", {layered_run(4.0, 0.85, 12, 15, 0.1).box(167)}}}},
      {"larger-box",
       kOpen,
       "steps of L / n",
       {{"layers", {layered_run(4.0, 0.85, 12, 15, 1)}}, {"large", {layered_run(4.0, 0.85, 11, 18, 1).box(167)}}}},

      // motion
      {"tilt", kAgrees, "", tilted(-0.9, 0.2, 0.3, 0.02)},
      {"tilt", kPartly, "no reversal", tilted(-0.9, 0.2, -0.3, 0.02)},
      {"tilt", kDisagrees, "with the tilt, and elsewhere", tilted(0.9, 0.33, -0.3, 0.02)},
      {"tilt", kOpen, "noise beyond 0.3", tilted(-0.9, 0.2, 0.1, 0.2)},
      {"sideways", kAgrees, "noise about zero", sideways(0.01, 0, 0.01)},
      {"sideways", kDisagrees, "a drift", sideways(0.01, 0.1, 0.01)},
      {"sideways", kOpen, "large errors", sideways(0.5, 0, 0.5)},
      {"switching",
       kAgrees,
       "twice a second",
       {{"mechanism", {MadeUp(2.5, 0.65).scalar("n_z_switching_time_s", 0.5, 0.1)}}}},
      {"switching",
       kDisagrees,
       "never in 30 s",
       {{"mechanism", {MadeUp(2.5, 0.65).scalar("n_z_switching_time_s", 60, 5)}}}},
      {"switching", kOpen, "errors", {{"mechanism", {MadeUp(2.5, 0.65).scalar("n_z_switching_time_s", 9, 5)}}}},
      {"persistence", kAgrees, "", ways(0.5, 2, 1, 4, 0.1)},
      {"persistence", kPartly, "longer, but no farther", ways(0.5, 2, 4, 1, 0.1)},
      {"persistence", kDisagrees, "", ways(2, 0.5, 4, 1, 0.1)},
      {"persistence", kOpen, "errors", ways(0.5, 2, 1, 4, 2)},
      {"diffusion-rises", kAgrees, "", scalars(2.5, "diffusion_mm2_s", {{0.65, 2}, {0.75, 7}, {0.85, 20}}, 0.5)},
      {"diffusion-rises", kDisagrees, "", scalars(2.5, "diffusion_mm2_s", {{0.65, 20}, {0.75, 7}, {0.85, 2}}, 0.5)},
      {"diffusion-rises", kDisagrees, "a step back",
       scalars(2.5, "diffusion_mm2_s", {{0.65, 2}, {0.75, 20}, {0.85, 7}}, 0.5)},
      {"diffusion-rises", kOpen, "errors", scalars(2.5, "diffusion_mm2_s", {{0.65, 2}, {0.85, 3}}, 2)},
      {"diffusion-law", kAgrees, "", law(1.0, 0.02)},
      {"diffusion-law", kDisagrees, "twice as fast", law(2.0, 0.02)},
      {"diffusion-law", kPartly, "at the lowest packing only",
       scalars(2.5, "diffusion_mm2_s", {{0.65, 1.8}, {0.85, 8.8}}, 0.03)},
      {"diffusion-law", kPartly, "runs that were made for it decide",
       scalars(2.5, "diffusion_mm2_s", {{0.65, 1.8}, {0.80, 6}}, 0.03) +
           MadeUpSets{{"diffusion", {MadeUp(2.5, 0.80).scalar("diffusion_mm2_s", 9, 0.1)}}}},
      {"diffusion-law", kOpen, "errors", law(1.0, 0.2)},
      {"diffusion-normal", kAgrees, "", exponents(2.5, "alpha", {1.0, 1.02}, {1.0, 0.98}, 0.01)},
      {"diffusion-normal", kPartly, "faster at long times when dense",
       exponents(2.5, "alpha", {1.0, 1.02}, {1.0, 1.3}, 0.01)},
      {"diffusion-normal", kDisagrees, "nowhere", exponents(2.5, "alpha", {0.6, 0.5}, {1.4, 1.3}, 0.01)},
      {"diffusion-normal", kOpen, "errors", exponents(2.5, "alpha", {1.0, 1.02}, {1.0, 0.98}, 0.1)},
      {"diffusion-along", kAgrees, "", along_director(3.6, 6.4, 3.7, 0.06, 0.2)},
      {"diffusion-along", kPartly, "falls at once", along_director(6.4, 3.6, 1, 0.06, 0.2)},
      {"diffusion-along", kDisagrees, "all the other way round", along_director(0.5, 0.2, 0.5, 0.4, 0.02)},
      {"diffusion-along", kOpen, "errors", along_director(3.6, 6.4, 3.7, 0.06, 3)},
      {"diffusion-across", kAgrees, "", exponents(4.5, "alpha_across", {1.0, 0.7}, {1.0, 0.9}, 0.01)},
      {"diffusion-across", kPartly, "super-diffusive at long times",
       exponents(4.5, "alpha_across", {1.0, 0.7}, {1.2, 0.9}, 0.01)},
      {"diffusion-across", kDisagrees, "everywhere, and rising",
       exponents(4.5, "alpha_across", {1.2, 1.4}, {1.2, 1.2}, 0.01)},
      {"diffusion-across", kOpen, "errors", exponents(4.5, "alpha_across", {1.0, 0.7}, {1.0, 0.9}, 0.2)},
      {"memory", kAgrees, "", memory(0.1, 1.7, 0.2, 1.2, 0.01)},
      {"memory", kPartly, "velocities forget sooner", memory(0.1, 1.7, 1.2, 0.2, 0.01)},
      {"memory", kDisagrees, "", memory(1.7, 0.1, 1.2, 0.2, 0.01)},
      {"memory", kOpen, "errors", memory(0.1, 1.7, 0.2, 0.3, 0.2)},
      {"c2-plateau", kAgrees, "", scalars(4.5, "c2_plateau", {{0.60, 0.6}, {0.75, 0.8}, {0.85, 0.93}}, 0.01)},
      {"c2-plateau", kPartly, "grows to a half", scalars(4.5, "c2_plateau", {{0.60, 0.2}, {0.85, 0.5}}, 0.01)},
      {"c2-plateau", kDisagrees, "", scalars(4.5, "c2_plateau", {{0.60, 0.6}, {0.85, 0.1}}, 0.01)},
      {"c2-plateau", kOpen, "errors", scalars(4.5, "c2_plateau", {{0.60, 0.6}, {0.85, 0.93}}, 0.2)},
      {"velocity-along", kAgrees, "",
       scalars(4.5, "velocity_variance_along_mm2_s2", {{0.60, 2}, {0.80, 4}, {0.85, 1}}, 0.1)},
      {"velocity-along", kDisagrees, "",
       scalars(4.5, "velocity_variance_along_mm2_s2", {{0.60, 4}, {0.80, 2}, {0.85, 9}}, 0.1)},
      {"velocity-along", kOpen, "errors",
       scalars(4.5, "velocity_variance_along_mm2_s2", {{0.60, 2}, {0.80, 4}, {0.85, 1}}, 2)},
      {"rotation", kAgrees, "", scalars(2.5, "rotational_diffusion_rad2_s", {{0.45, 2}, {0.85, 1}}, 0.1)},
      {"rotation", kDisagrees, "", scalars(2.5, "rotational_diffusion_rad2_s", {{0.45, 1}, {0.85, 2}}, 0.1)},
      {"rotation", kOpen, "errors", scalars(2.5, "rotational_diffusion_rad2_s", {{0.45, 1.1}, {0.85, 1}}, 0.1)},
      {"rotation-short", kAgrees, "", scalars(2.5, "alpha_rotation_short", {{0.45, 0.98}, {0.85, 0.65}}, 0.005)},
      {"rotation-short", kPartly, "super-diffusive when dilute",
       scalars(2.5, "alpha_rotation_short", {{0.45, 1.039}, {0.85, 0.65}}, 0.005)},
      {"rotation-short", kDisagrees, "everywhere, and rising",
       scalars(2.5, "alpha_rotation_short", {{0.45, 1.1}, {0.85, 1.3}}, 0.005)},
      {"rotation-short", kOpen, "errors", scalars(2.5, "alpha_rotation_short", {{0.45, 0.99}, {0.85, 0.65}}, 0.05)},
      {"rotation-saturates", kAgrees, "", scalars(4.5, "alpha_rotation_long", {{0.45, 1.0}, {0.80, 0.1}}, 0.02)},
      {"rotation-saturates", kPartly, "it goes on in the nematic",
       scalars(4.5, "alpha_rotation_long", {{0.45, 1.0}, {0.80, 0.9}}, 0.02)},
      {"rotation-saturates", kDisagrees, "", scalars(4.5, "alpha_rotation_long", {{0.45, 0.1}, {0.80, 0.9}}, 0.02)},
      {"rotation-saturates", kOpen, "errors", scalars(4.5, "alpha_rotation_long", {{0.45, 1.0}, {0.80, 0.1}}, 0.2)},
      {"defects", kAgrees, "head first", defects(-4.1, 0.3)},
      {"defects", kDisagrees, "no more than a tenth of the jitter", defects(0.1, 0.1)},
      {"defects", kOpen, "errors", defects(-4, 3)},
  };
}

const Claim& claim_called(const std::string& id) {
  const auto all = paper_claims();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Claim& claim) { return claim.id == id; });
  EXPECT_NE(found, all.end()) << "no claim " << id;
  return *found;
}

std::string told(const Case& c, const Finding& finding) {
  return c.claim + " (" + c.because + "): " + std::string(word(finding.verdict)) + ": " + finding.found + " [" +
         finding.why + "]";
}

/// The same runs with something done to each.
template <class Change>
Library changed(const Case& c, Change change) {
  MadeUpSets sets = c.runs;
  for (auto& [name, runs] : sets) {
    for (MadeUp& run : runs) change(run);
  }
  return library_of(sets);
}

TEST(Claims, SayWhatTheRunsSay) {
  for (const Case& c : cases()) {
    const Finding finding = claim_called(c.claim).check(library_of(c.runs));
    EXPECT_EQ(word(finding.verdict), word(c.verdict)) << told(c, finding);
    EXPECT_EQ(finding.why.empty(), finding.verdict != Verdict::kUnresolved) << told(c, finding);
    EXPECT_FALSE(finding.found.empty()) << c.claim;
  }
}

TEST(Claims, HaveACaseForEverythingTheyCanSay) {
  std::map<std::string, std::set<Verdict>> tested;
  for (const Case& c : cases()) tested[c.claim].insert(c.verdict);
  for (const Claim& claim : paper_claims()) {
    std::set<Verdict> can{kAgrees, kDisagrees, kOpen};
    if (claim.reach == Reach::kCannotAgree) can.erase(kAgrees);
    if (claim.reach == Reach::kCannotDisagree) can.erase(kDisagrees);
    for (const Verdict verdict : can) {
      EXPECT_TRUE(tested[std::string(claim.id)].contains(verdict)) << claim.id << " has no case that " << word(verdict);
    }
    EXPECT_TRUE(claim.reach == Reach::kEitherWay || !claim.note.empty()) << claim.id << " does not say why";
  }
}

/// "steady-state" is about relaxing itself, and counts steady runs without an error.
bool is_about_steadiness(const Case& c) { return c.claim == "steady-state"; }

TEST(Claims, AreNotResolvedByRunsThatStillRelax) {
  for (const Case& c : cases()) {
    if (c.verdict == kOpen || is_about_steadiness(c)) continue;
    const Finding relaxing = claim_called(c.claim).check(changed(c, [](MadeUp& run) { run.relaxing(); }));
    EXPECT_EQ(relaxing.verdict, kOpen) << told(c, relaxing);
    EXPECT_THAT(relaxing.why, HasSubstr("still relaxes")) << told(c, relaxing);
    const Finding untested = claim_called(c.claim).check(changed(c, [](MadeUp& run) { run.untested(); }));
    EXPECT_EQ(untested.verdict, kOpen) << told(c, untested);
    EXPECT_THAT(untested.why, HasSubstr("not known whether a run is steady")) << told(c, untested);
  }
}

TEST(Claims, AreNotResolvedByNumbersWithoutErrors) {
  for (const Case& c : cases()) {
    if (c.verdict == kOpen || is_about_steadiness(c)) continue;
    const Finding finding = claim_called(c.claim).check(changed(c, [](MadeUp& run) { run.without_errors(); }));
    EXPECT_EQ(finding.verdict, kOpen) << told(c, finding);
  }
}

TEST(Claims, WithoutRunsThereIsNoData) {
  for (const Json& finding : claims_json(Library(), paper_claims())) {
    EXPECT_EQ(finding.at("verdict"), "no data") << finding;
  }
  const std::string table = claims_table(Library(), paper_claims());
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), static_cast<std::ptrdiff_t>(paper_claims().size() + 2));
}

TEST(Claims, TableSaysWhyAndWhichWay) {
  const Library relaxing = library_of({{"phases", {MadeUp(4.5, 0.75).order(0.9).relaxing()}}});
  const std::string table = claims_table(relaxing, paper_claims());
  EXPECT_THAT(table, HasSubstr("S = 0.900 ± 0.010 (still relaxing) | not resolved: a run still relaxes |"));
  EXPECT_THAT(table, HasSubstr("The order is long-range. *Runs like these can refute it only:*"));
}

TEST(Claims, OfTheFiguresAskedForOnly) {
  const std::vector<std::string_view> ten{"10"};
  for (const Claim& claim : claims_of(ten)) EXPECT_EQ(claim.figure, "10");
  EXPECT_EQ(claims_of(ten).size(), 3u);
  EXPECT_EQ(claims_of({}).size(), paper_claims().size());
}

TEST(Claims, PointAtFiguresThatExist) {
  std::set<std::string_view> figures, ids;
  for (const PaperFigure& figure : paper_figures()) EXPECT_TRUE(figures.insert(figure.id()).second) << figure.id();
  for (const Claim& claim : paper_claims()) {
    EXPECT_TRUE(figures.contains(claim.figure)) << claim.id;
    EXPECT_TRUE(ids.insert(claim.id).second) << claim.id;
  }
}

TEST(Trend, IsHeldAgainstItsErrorsAndStepsBack) {
  const auto points = [](std::vector<double> values, double sem) {
    std::vector<Point> all;
    for (const double value : values) {
      all.push_back({static_cast<double>(all.size()), {.value = value, .sem = sem, .steady = true}});
    }
    return all;
  };
  EXPECT_EQ(trend(points({1, 2, 3}, 0.1), true), yes());
  EXPECT_EQ(trend(points({3, 2, 1}, 0.1), false), yes());
  EXPECT_EQ(trend(points({1, 2, 3}, 0.1), false), no());
  EXPECT_EQ(trend(points({1, 3, 2}, 0.1), true), no()) << "ten errors back";
  EXPECT_EQ(trend(points({1, 2, 1.8, 3}, 0.1), true), yes()) << "one and a half are chance";
  EXPECT_EQ(trend(points({1, 2}, 1), true).word, Answer::Word::kUnknown);
  auto relaxing = points({1, 2}, 0.1);
  relaxing[1].estimate.steady = false;
  EXPECT_EQ(trend(relaxing, true), unknown("a run still relaxes"));
}

TEST(Comparison, CountsADriftWhereNobodyKnowsWhetherTheRunIsSteady) {
  Estimate estimate{.value = 1, .sem = 0.1, .steady = true, .drift = 0.3, .drift_sem = 0.2};
  EXPECT_EQ(above(estimate, 0.7), yes()) << "three errors";
  EXPECT_EQ(close_to(estimate, 1, 0.3), yes());
  EXPECT_EQ(text(estimate), "1.00 ± 0.10");
  estimate.steady = std::nullopt;  // judged with 0.37
  EXPECT_EQ(above(estimate, 0.7), unknown("the errors are too large"));
  EXPECT_EQ(above(estimate, 0.2), yes());
  EXPECT_EQ(close_to(estimate, 1, 0.3), unknown("the errors are too large"));
  EXPECT_EQ(text(estimate), "1.00 ± 0.10 (drift 0.30 ± 0.20)");
}

TEST(Doubt, IsWhatKeepsANumberFromDeciding) {
  EXPECT_EQ(doubt({.value = 1, .sem = 0.1, .steady = true}), "");
  EXPECT_EQ(doubt({.value = 1, .sem = 0.1, .steady = false}), "a run still relaxes");
  EXPECT_EQ(doubt({1, 0.1}), "not known whether a run is steady");
  EXPECT_EQ(doubt({.value = 1, .sem = 0.1, .drift = 0.1, .drift_sem = 0.1}), "") << "a drift that is known";
  EXPECT_EQ(doubt({.value = 1, .sem = 0.1, .steady = false, .drift = 0.1, .drift_sem = 0.1}), "a run still relaxes");
  EXPECT_EQ(doubt({.value = 1, .sem = NAN, .steady = true}), "too few independent samples for an error");
  EXPECT_EQ(doubt({}), "not measured everywhere");
}

}  // namespace
}  // namespace shaken::study
