#include "analysis/clusters.h"

#include <bit>
#include <cmath>

#include "analysis/errors/blocked.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

void put_points(Reduction& result, const std::string& path, const std::vector<Scalar>& points) {
  put(result, path, "", std::vector<analysis::Estimate>(points.begin(), points.end()));
}

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
  const int n_octaves = std::bit_width(static_cast<unsigned>(system.n_rods));  // that sizes can be in
  const auto sample = [axes, region, rule](const Sample& now, auto& series, auto& statistics) {
    const auto sizes = analysis::cluster_sizes(now->position, now->director, axes, region, rule);
    series.accumulate(now->time, sizes);
    statistics.accumulate(now->time, sizes);
  };
  const auto reduce = [n_octaves](Reduction& result, const auto& series, const auto& statistics) {
    result.arrays["/clusters/time_s"] = series.times();
    result.arrays["/clusters/largest"] = series.largest();
    result.arrays["/clusters/size"] = series.sizes();
    const auto found = [&](const auto& choose) {
      return block_estimates(statistics, result.t_steady,
                             [&](const analysis::ClusterStatistics& part) { return choose(part.reduce()); });
    };
    const auto of_octaves = [&](auto member) {
      return found([&](const analysis::ClusterNumbers& numbers) {
        const auto& octaves = numbers.*member;
        return std::vector<double>(octaves.begin(), octaves.begin() + n_octaves);
      });
    };
    std::vector<double>& smallest = result.arrays["/clusters/sizes/size"];
    for (int k = 0; k < n_octaves; ++k) smallest.push_back(std::exp2(k));
    put_points(result, "/clusters/sizes/rods", of_octaves(&analysis::ClusterNumbers::rods));
    put_points(result, "/clusters/sizes/density", of_octaves(&analysis::ClusterNumbers::density));
    const auto numbers = found([](const analysis::ClusterNumbers& all) {
      return std::vector<double>{all.largest, all.size, all.alone, all.per_rod};
    });
    result.scalars["largest_cluster"] = numbers[0];
    result.scalars["cluster_size"] = numbers[1];
    result.scalars["rods_alone"] = numbers[2];
    result.scalars["clusters_per_rod"] = numbers[3];
  };
  return measured(sample, reduce, analysis::ClusterSeries(), analysis::Blocked(analysis::ClusterStatistics()));
}

}  // namespace

MeasurementKind clusters_kind() {
  return {
      .name = "clusters",
      .sources = "clusters, geometry/region",
      .make = measure_clusters,
      .arrays =
          {
              called("time", "t",
                     {"time_s", "times of the next two; of more than 65,536 samples, each point is a mean of several"}),
              called("share of the largest cluster", "",
                     {"largest", "share of the rods that are in the largest cluster"}),
              {"size", "number of rods in the cluster of a rod, mean over rods"},
              called("cluster size", "s",
                     {"sizes/size",
                      "smallest of the sizes that are counted together: those below the next, which is twice it"}),
              {"sizes/rods", "share of the rods that are in clusters of these sizes", kWithError},
              called("clusters per rod", "n(s)",
                     {"sizes/density", "n(s): clusters of one size over rods, mean over these sizes", kWithError}),
          },
      .numbers =
          {
              called("share of the largest cluster", "",
                     {"largest_cluster", "share of the rods that are in the largest cluster"}),
              called("mean cluster size", R"(\langle s^2\rangle/\langle s\rangle)",
                     {"cluster_size", "number of rods in the cluster of a rod, mean over rods: ⟨s²⟩/⟨s⟩"}),
              {"rods_alone", "share of the rods without a neighbour"},
              {"clusters_per_rod", "number of clusters over number of rods; a rod alone is a cluster"},
          },
  };
}

}  // namespace shaken::run
