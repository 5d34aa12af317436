#pragma once

#include <optional>

#include "scene/keys/run_plan.h"
#include "sim/rod/species.h"

/// Quantities that a scene may be written in and that a plan does not store.
namespace shaken::scene {

inline constexpr double kDefaultBeadPitch = 0.3;            ///< [mm]; gives the paper's numbers of rods
inline constexpr double kDefaultAreaFraction = 0.75;        ///< ordered at l = 4.5 mm
inline constexpr double kDefaultGamma = 7.0;                ///< the paper's
inline constexpr double kMaxAreaFractionAligned = 0.92;     ///< interlocked rows of tapered rods get no further
inline constexpr double kMaxAreaFractionRandom = 0.45;      ///< random insertion of rods jams there
inline constexpr double kMaxAreaFractionCompressed = 0.86;  ///< 0.85, in whole rods; rods that are compressed can jam

/// Gamma = a (2 pi f)^2 / g; none without gravity.
std::optional<double> gamma_of(const System& scene);
/// a from Gamma, f and g [mm].
double amplitude_for(double gamma, double frequency, double gravity);
/// f from Gamma, a and g [Hz].
double frequency_for(double gamma, double amplitude, double gravity);

/// make_species(rod), kept from the last few calls: the points of a sweep ask for the same shapes over and over, and
/// integrating one takes as long as much else that a point needs.
Species species_of(const RodShape& rod);
/// The same of every size that rods of that species have.
std::vector<Species> sizes_of_species(const RodShape& rod);
/// Diameter of the thickest bead [mm].
double thickest_bead(const RodShape& rod);
/// What a rod covers, lying flat, on average over the sizes [mm^2].
double mean_area_of(const RodShape& rod);

/// The area fraction of the rods of the first species: N A / L^2, with A the area of one rod lying flat.
double area_fraction_of(const System& scene);
/// The area fraction of the rods of all species.
double total_area_fraction_of(const System& scene);
/// The area fraction of `count` rods of any species.
double area_fraction_of(const System& scene, const RodShape& rod, int count);

}  // namespace shaken::scene
