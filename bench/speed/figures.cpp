// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "bench/picture.h"
#include "bench/speed/report.h"

namespace shaken::bench {
namespace {

constexpr const char* kScheduledColour = "#3b528b";
constexpr const char* kReferenceColour = "#5ec962";
/// One per phase, along viridis (van der Walt & Smith 2015).
constexpr std::array<const char*, kPhases> kPhaseColours{"#440154", "#443983", "#31688e", "#21918c",
                                                         "#35b779", "#90d743", "#fde725"};

}  // namespace

void draw_scenes(const std::filesystem::path& folder, const std::vector<SceneSpeed>& scenes) {
  std::string data = "# scene  scheduled  reference [rod-s/CPU-s]  ";
  for (const char* name : kPhaseNames) data += std::string(name) + " ";
  data += "[%]\n";
  for (const SceneSpeed& scene : scenes) {
    data += fmt::format("\"φ {}\\nℓ {}\\nL {:.3g}\" {:.6g} {:.6g}", scene.scene.area_fraction, scene.scene.length,
                        scene.scene.side, scene.scheduled.rate(), scene.reference.rate());
    for (const double seconds : scene.phases) data += fmt::format(" {:.4g}", 100 * seconds / scene.phases_cpu);
    data += '\n';
  }

  const int width = std::max(1400, 200 + 2 * 70 * static_cast<int>(scenes.size()));
  std::string script = gnuplot_prologue("speed", width, 700);
  script += R"(set style data histograms
set style fill solid 1 border rgb '#ffffff'
set xtics scale 0 font ',13' offset 0,-0.5
set bmargin 6
set key above horizontal samplen 1 spacing 1.1 font ',14'
set multiplot layout 1,2
set title 'simulated rod-seconds per CPU-second'
set style histogram clustered gap 1
set logscale y
set yrange [1:*]
set boxwidth 0.9
)";
  script += fmt::format(
      "set xrange [-0.6:{}]\n"
      "plot 'speed.dat' using 2:xtic(1) title 'scheduled' linecolor '{}', "
      "'' using 3 title 'reference' linecolor '{}', "
      "'' using ($0-0.17):2:(sprintf('%.0f', $2)) with labels font ',12' offset 0,0.6 notitle, "
      "'' using ($0+0.17):3:(sprintf('%.0f', $3)) with labels font ',12' offset 0,0.6 notitle\n",
      static_cast<double>(scenes.size()) - 0.4, kScheduledColour, kReferenceColour);
  script += R"(unset logscale y
set yrange [0:100]
set title 'CPU time of the scheduled engine (%)'
set style histogram rowstacked
set boxwidth 0.7
)";
  for (std::size_t p = 0; p < kPhases; ++p) {
    script += fmt::format("{}'speed.dat' using {}{} title '{}' linecolor '{}'", p == 0 ? "plot " : ", ", 4 + p,
                          p == 0 ? ":xtic(1)" : "", kPhaseNames[p], kPhaseColours[p]);
  }
  draw(folder, "speed", data, script + "\nunset multiplot\n");
}

void draw_scaling(const std::filesystem::path& folder, const Scaling& scaling) {
  const bool of_rods = scaling.of == Scaling::Of::kRods;
  const std::string name = of_rods ? "scaling_n" : "scaling_dt";
  std::string data = "# " + std::string(of_rods ? "rods" : "step [us]") + "  CPU time per rod-second, relative\n";
  for (std::size_t k = 0; k < scaling.points.size(); ++k) {
    const Case& scene = scaling.points[k].scene;
    data += fmt::format("{:.10g} {:.6g}\n", of_rods ? scene.system().n_rods : 1e6 * scene.dt, scaling.relative(k));
  }
  std::string script = gnuplot_prologue(name, 1100, 750);
  script += fmt::format("set logscale x{}\nset yrange [0:*]\nset offsets graph 0.05, graph 0.05, graph 0.1, 0\n",
                        of_rods ? "" : " 2");
  script += fmt::format("set xlabel '{}'\nset ylabel 'CPU time per rod-second, relative to {}'\nset key top {}\n",
                        of_rods ? "number of rods N" : "step {/Symbol D}t (μs)",
                        of_rods ? "the smallest N" : "the longest step", of_rods ? "left" : "right");
  // what an engine whose ticks all cost the same would take
  const std::string guide = of_rods ? "1" : fmt::format("{:.10g}/x", 1e6 * scaling.points.front().scene.dt);
  script += fmt::format(
      "plot '{}.dat' using 1:2 with linespoints pointtype 7 pointsize 1.5 linecolor '{}' title 'scheduled', "
      "{} with lines linecolor '#999999' dashtype 2 title '{}'\n",
      name, kScheduledColour, guide,
      of_rods ? "cost of a rod independent of N" : "cost of a step independent of its length");
  draw(folder, name, data, script);
}

}  // namespace shaken::bench
