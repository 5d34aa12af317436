#include "analysis/layers.h"

#include <cmath>

#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

/// Layers: their spectrum, wavelength and order.
std::unique_ptr<Measurement> measure_layers(const MeasureContext& context) {
  const System& system = context.plan.system;
  const auto sample = [](const Sample& now, auto& blocks) {
    blocks.accumulate(now->time, now->position, now->director);
  };
  const auto reduce = [](Reduction& result, const auto& blocks) {
    const analysis::LayerOrder layers = blocks.after(result.t_steady);
    const analysis::LayerSpectrum spectrum = layers.reduce();
    result.arrays["/layers/q_per_mm"] = spectrum.q;
    result.arrays["/layers/spectrum_across"] = spectrum.across;
    result.arrays["/layers/spectrum_along"] = spectrum.along;
    const std::optional<analysis::LayerPeak> peak = layers.peak();
    if (!peak) return;
    // The errors are those of the one peak, not of which is the highest; and of the steps in which waves fit the box.
    const auto found = block_estimates(blocks, result.t_steady, [&](const analysis::LayerOrder& part) {
      const analysis::LayerPeak same = part.peak_at(peak->m, peak->n);
      return std::vector<double>{same.wavelength, same.side / same.wavelength, same.order};
    });
    const auto with_steps = [&](const Scalar& of_blocks, double step) -> Scalar {
      if (!peak->stands_out()) return {};  // there are no layers to have a wavelength
      Scalar scalar = of_blocks;
      scalar.sem = std::hypot(of_blocks.sem, step / std::sqrt(12.0));
      return scalar;
    };
    result.scalars["wavelength_mm"] = with_steps(found[0], peak->wavelength * peak->wavelength / peak->side);
    result.scalars["layers_per_box"] = with_steps(found[1], 1);
    result.scalars["layer_order"] = found[2];
  };
  return measured(sample, reduce, analysis::Blocked(analysis::LayerOrder(system.box(), system.rod.length / 2)));
}

}  // namespace

MeasurementKind layers_kind() {
  return {
      .name = "layers",
      .sources = "layers, geometry/wave_sums",
      .make = measure_layers,
      .arrays =
          {
              called("wave number across the director", "q_⊥",
                     {"q_per_mm", "wave numbers 2πk/L, L being the longer side of the box"}),
              called("spectrum of the layers", R"(\langle|s(q_⊥)|^2\rangle)",
                     {"spectrum_across", "power of sin 2(θ - director), wave vectors across the director"}),
              {"spectrum_along", "wave vectors along it"},
          },
      .numbers =
          {
              called("wavelength of the layers", "λ",
                     {"wavelength_mm", "wavelength of the layers; null where there are none"}),
              {"layers_per_box", "side of the box across the layers, over that wavelength"},
              called("order of the layers", "",
                     {"layer_order", "amplitude of the wave of sin 2(θ − θ_N) with the most power"}),
          },
      .needs = {Needs::kTilts},
  };
}

}  // namespace shaken::run
