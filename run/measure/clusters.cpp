#include "analysis/clusters.h"

#include <bit>
#include <cmath>

#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::ClusterNumbers;
using analysis::ClusterSeries;

/// The distribution over the octaves that sizes can be in.
struct ClusterSizes {
  std::vector<double> smallest, rods, density;
};

constexpr std::array kClusterSeries{
    from<&ClusterSeries::times>(
        called("time", "t",
               {"time_s", "times of the next two; of more than 65,536 samples, each point is a mean of several"})),
    from<&ClusterSeries::largest>(
        called("share of the largest cluster", "", {"largest", "share of the rods that are in the largest cluster"})),
    from<&ClusterSeries::sizes>({"size", "number of rods in the cluster of a rod, mean over rods"}),
};
constexpr std::array kClusterSizes{
    from<&ClusterSizes::smallest>(called(
        "cluster size", "s",
        {"sizes/size", "smallest of the sizes that are counted together: those below the next, which is twice it"})),
    from<&ClusterSizes::rods>({"sizes/rods", "share of the rods that are in clusters of these sizes", kWithError}),
    from<&ClusterSizes::density>(
        called("clusters per rod", "n(s)",
               {"sizes/density", "n(s): clusters of one size over rods, mean over these sizes", kWithError})),
};
constexpr std::array kClusterNumbers{
    from<&ClusterNumbers::largest>(called("share of the largest cluster", "",
                                          {"largest_cluster", "share of the rods that are in the largest cluster"})),
    from<&ClusterNumbers::size>(
        called("mean cluster size", R"(\langle s^2\rangle/\langle s\rangle)",
               {"cluster_size", "number of rods in the cluster of a rod, mean over rods: ⟨s²⟩/⟨s⟩"})),
    from<&ClusterNumbers::alone>({"rods_alone", "share of the rods without a neighbour"}),
    from<&ClusterNumbers::per_rod>(
        {"clusters_per_rod", "number of clusters over number of rods; a rod alone is a cluster"}),
};

std::unique_ptr<Measurement> measure_clusters(const MeasureContext& context) {
  const scene::MeasureClusters& settings = *context.plan.clusters;
  const System& system = context.plan.system;
  const analysis::ClusterRule rule{
      .distance = settings.distance_for(system.rod.mid_diameter),
      .angle = system.rod.has_axis() ? settings.angle * kPi / 180 : kPi / 2,
  };
  const auto axes = context.of_rods([](const Species& rod) {
    return analysis::RodAxis{rod.tail.length, rod.head.length};
  });
  const analysis::Region region(system.box(), system.walls);
  const auto n_octaves = static_cast<std::size_t>(std::bit_width(static_cast<unsigned>(system.n_rods)));
  const auto sample = [axes, region, rule](const Sample& now, auto& series, auto& statistics) {
    const auto sizes = analysis::cluster_sizes(now->position, now->director, axes, region, rule);
    series.accumulate(now->time, sizes);
    statistics.accumulate(now->time, sizes);
  };
  const auto reduce = [n_octaves](Reduction& result, const auto& series, const auto& statistics) {
    put(result, "/clusters/", kClusterSeries, series);
    put(result, "/clusters/", kClusterSizes, statistics, [&](const analysis::ClusterStatistics& part) {
      const ClusterNumbers found = part.reduce();
      ClusterSizes sizes;
      for (std::size_t k = 0; k < n_octaves; ++k) {
        sizes.smallest.push_back(std::exp2(k));
        sizes.rods.push_back(found.rods[k]);
        sizes.density.push_back(found.density[k]);
      }
      return sizes;
    });
    put(result, "", kClusterNumbers, statistics);
  };
  return measured(sample, reduce, analysis::ClusterSeries(), analysis::Blocked(analysis::ClusterStatistics()));
}

}  // namespace

MeasurementKind clusters_kind() {
  return {
      .name = "clusters",
      .sources = "clusters, geometry/region",
      .make = measure_clusters,
      .arrays = outputs_of(kClusterSeries, kClusterSizes),
      .numbers = outputs_of(kClusterNumbers),
  };
}

}  // namespace shaken::run
