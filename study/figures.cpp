// SPDX-License-Identifier: MIT
#include "study/figures.h"

#include <fmt/format.h>

namespace shaken::study {

std::string PaperFigure::file() const {
  return number.empty() ? std::string(name) : fmt::format("fig{:0>2}-{}", number, name);
}

std::span<const PaperFigure> paper_figures() {
  static const std::vector<PaperFigure> kFigures{
      {"2",
       "start",
       "Rods as they lie, and S(t) from the aligned start",
       {"phases", "transition", "movies"},
       start_figure},
      {"3",
       "order",
       "Nematic order against area fraction and rod length: mean, phase diagram",
       {"phases", "transition"},
       order_figure},
      {"4",
       "order-statistics",
       "Fluctuations of the order: P[S], standard deviation, Binder cumulant",
       {"phases", "transition"},
       order_statistics_figure},
      {"5", "g2", "Orientational correlation against distance, G_2(r)", {"phases", "transition"}, g2_figure},
      {"6", "g2-map", "Orientational correlation along and across the director", {"layers", "size"}, g2_map_figure},
      {"7",
       "distances",
       "Pair correlation g: against distance, along and across the director",
       {"phases", "transition", "layers", "size"},
       distances_figure},
      {"8", "layers", "Layers turned by ±θ", {"layers"}, layers_figure},
      {"9",
       "diffusion",
       "Mean square displacement and diffusion",
       {"phases", "transition", "diffusion"},
       diffusion_figure},
      {"10", "tilt", "How a rod swims: velocity against tilt", {"mechanism"}, tilt_figure},
      {"11", "paths", "Paths of single rods, and how long they persist", {"mechanism"}, paths_figure},
      {"12", "memory", "Correlations in time: orientation C_2, velocity C_v", {"phases", "transition"}, memory_figure},
      {"13",
       "rotation",
       "Mean square angular displacement and rotational diffusion",
       {"phases", "transition"},
       rotation_figure},
      {"14", "defects", "Defects of a locally ordered system", {"defects"}, defects_figure},
      {"",
       "layer-trends",
       "Layer angle, wavelength and order against packing, length and end radius",
       {"layers"},
       layer_trends_figure},
      {"", "larger-box", "The layers in a larger box", {"layers", "large"}, larger_box_figure},
      {"", "gap", "The gap between the plates: crystal, layers, no layers", {"layers", "gaps"}, gap_figure},
      {"",
       "steady",
       "On the way to the steady state at l = 3.5 mm",
       {"phases", "transition", "layers"},
       steady_state_figure},
      {"", "shaking", "Order and diffusion against the strength of shaking", {"shaking", "rest"}, shaking_figure},
      {"", "melting", "Defect density and melting", {"phases", "transition", "defects"}, melting_figure},
      {"", "size", "Order against the size of the box", {"phases", "transition", "size"}, size_figure},
      {"",
       "fluctuations",
       "Number fluctuations, with and without the mean density map",
       {"phases", "transition", "layers", "equilibrium"},
       fluctuations_figure},
      {"", "elasticity", "Director fluctuations: bend against splay", {"layers"}, elasticity_figure},
      {"",
       "equilibrium",
       "The equilibrium reference: e = 1, no friction",
       {"phases", "transition", "equilibrium"},
       equilibrium_figure},
      {"", "movies", "Films S1 to S7", {"movies"}, nullptr},
  };
  return kFigures;
}

std::vector<std::string_view> all_sets() {
  return {"mechanism", "phases",  "layers", "diffusion", "transition", "gaps",  "equilibrium",
          "shaking",   "defects", "size",   "large",     "rest",       "movies"};
}

}  // namespace shaken::study
