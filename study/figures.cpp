// SPDX-License-Identifier: MIT
#include "study/figures.h"

namespace shaken::study {

std::span<const PaperFigure> paper_figures() {
  static const std::vector<PaperFigure> kFigures{
      {"2",
       "fig02-order",
       "Nematic order against area fraction and rod length",
       {"phases", "transition"},
       order_figure},
      {"3",
       "fig03-order-statistics",
       "Fluctuations of the order: P[S], Binder cumulant",
       {"phases", "transition"},
       order_statistics_figure},
      {"4",
       "fig04-correlations",
       "Correlations against distance: G_2(r), g(r)",
       {"phases", "transition"},
       correlation_figure},
      {"5", "fig05-maps", "Correlations along and across the director", {"layers", "size"}, pair_map_figure},
      {"6", "fig06-layers", "Layers turned by ±θ", {"layers"}, layers_figure},
      {"7",
       "fig07-layer-trends",
       "Layer angle, wavelength and order against packing, length and end radius",
       {"layers"},
       layer_trends_figure},
      {"8", "fig08-mechanism", "How a rod swims: velocity against tilt", {"mechanism"}, mechanism_figure},
      {"9",
       "fig09-diffusion",
       "Mean square displacement and diffusion",
       {"phases", "transition", "diffusion"},
       diffusion_figure},
      {"10",
       "fig10-rotation",
       "Correlations in time: velocity, orientation, rotation",
       {"phases", "transition"},
       rotation_figure},
      {"defects", "fig11-defects", "Defects of a locally ordered system", {"defects"}, defects_figure},
      {"larger-box", "figA1-larger-box", "The layers in a larger box", {"layers", "large"}, larger_box_figure},
      {"gap", "figA2-gap", "The gap between the plates: crystal, layers, no layers", {"layers", "gaps"}, gap_figure},
      {"steady",
       "figA3-steady-state",
       "On the way to the steady state at l = 3.5 mm",
       {"phases", "transition", "layers"},
       steady_state_figure},
      {"shaking",
       "figB1-shaking",
       "Order and diffusion against the strength of shaking",
       {"shaking", "rest"},
       shaking_figure},
      {"melting", "figB2-melting", "Defect density and melting", {"phases", "transition", "defects"}, melting_figure},
      {"size", "figB3-size", "Order against the size of the box", {"phases", "transition", "size"}, size_figure},
      {"fluctuations",
       "figB4-number-fluctuations",
       "Number fluctuations, with and without the mean density map",
       {"phases", "transition", "layers", "equilibrium"},
       fluctuations_figure},
      {"elasticity", "figB5-elasticity", "Director fluctuations: bend against splay", {"layers"}, elasticity_figure},
      {"equilibrium",
       "figB6-equilibrium",
       "The equilibrium reference: e = 1, no friction",
       {"phases", "transition", "equilibrium"},
       equilibrium_figure},
      {"movies", "movies", "Films S1 to S7", {"movies"}, nullptr},
  };
  return kFigures;
}

std::vector<std::string_view> all_sets() {
  return {"mechanism", "phases",  "layers", "diffusion", "transition", "gaps",  "equilibrium",
          "shaking",   "defects", "size",   "large",     "rest",       "movies"};
}

}  // namespace shaken::study
