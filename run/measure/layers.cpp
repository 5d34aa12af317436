#include "analysis/layers.h"

#include <cmath>
#include <optional>

#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::LayerSpectrum;
struct LayerWave {
  Scalar length, per_box, order;
};

constexpr std::array kLayerSpectrum{
    from<&LayerSpectrum::q>(called("wave number across the director", "q_⊥",
                                   {"q_per_mm", "wave numbers 2πk/L, L being the longer side of the box"})),
    from<&LayerSpectrum::across>(
        called("spectrum of the layers", R"(\langle|s(q_⊥)|^2\rangle)",
               {"spectrum_across", "power of sin 2(θ - director), wave vectors across the director"})),
    from<&LayerSpectrum::along>({"spectrum_along", "wave vectors along it"}),
};
constexpr std::array kLayerNumbers{
    from<&LayerWave::length>(called("wavelength of the layers", "λ",
                                    {"wavelength_mm", "wavelength of the layers; null where there are none"})),
    from<&LayerWave::per_box>({"layers_per_box", "side of the box across the layers, over that wavelength"}),
    from<&LayerWave::order>(called("order of the layers", "",
                                   {"layer_order", "amplitude of the wave of sin 2(θ − θ_N) with the most power"})),
};

/// Layers: their spectrum, wavelength and order.
std::unique_ptr<Measurement> measure_layers(const MeasureContext& context) {
  const System& system = context.plan.system;
  const auto sample = [](const Sample& now, auto& blocks) {
    blocks.accumulate(now->time, now->position, now->director);
  };
  const auto reduce = [](Reduction& result, const auto& blocks) {
    const analysis::LayerOrder layers = blocks.after(result.t_steady);
    put(result, "/layers/", kLayerSpectrum, layers.reduce());
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
    put(result, "", kLayerNumbers,
        LayerWave{with_steps(found[0], peak->wavelength * peak->wavelength / peak->side), with_steps(found[1], 1),
                  found[2]});
  };
  return measured(sample, reduce, analysis::Blocked(analysis::LayerOrder(system.box(), system.rod.length / 2)));
}

}  // namespace

MeasurementKind layers_kind() {
  return {
      .name = "layers",
      .sources = "layers, geometry/wave_sums",
      .make = measure_layers,
      .arrays = outputs_of(kLayerSpectrum),
      .numbers = outputs_of(kLayerNumbers),
      .needs = {Needs::kTilts},
  };
}

}  // namespace shaken::run
