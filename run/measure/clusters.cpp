// SPDX-License-Identifier: MIT
#include "analysis/clusters.h"

#include <bit>
#include <cmath>

#include "analysis/blocked.h"
#include "run/measure/estimates.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

class MeasuredClusters : public Measurement {
 public:
  MeasuredClusters(std::vector<analysis::RodAxis> axes, const analysis::ClusterRule& rule,
                   const analysis::Region& region, int n_rods)
      : axes_(std::move(axes)),
        rule_(rule),
        region_(region),
        n_octaves_(std::bit_width(static_cast<unsigned>(n_rods))) {}

  void sample(const Sample& sample) override {
    const auto sizes = analysis::cluster_sizes(sample->position, sample->director, axes_, region_, rule_);
    series_.accumulate(sample->time, sizes);
    statistics_.accumulate(sample->time, sizes);
  }
  void reduce(Reduction& result) const override {
    result.arrays["/clusters/time_s"] = series_.times();
    result.arrays["/clusters/largest"] = series_.largest();
    result.arrays["/clusters/size"] = series_.sizes();
    const auto found = [&](const auto& choose) {
      return block_estimates(statistics_, result.t_steady,
                             [&](const analysis::ClusterStatistics& part) { return choose(part.reduce()); });
    };
    const auto of_octaves = [&](auto member) {
      return found([&](const analysis::ClusterNumbers& numbers) {
        const auto& octaves = numbers.*member;
        return std::vector<double>(octaves.begin(), octaves.begin() + n_octaves_);
      });
    };
    std::vector<double>& smallest = result.arrays["/clusters/sizes/size"];
    for (int k = 0; k < n_octaves_; ++k) smallest.push_back(std::exp2(k));
    put_points(result, "/clusters/sizes/rods", of_octaves(&analysis::ClusterNumbers::rods));
    put_points(result, "/clusters/sizes/density", of_octaves(&analysis::ClusterNumbers::density));
    const auto numbers = found([](const analysis::ClusterNumbers& all) {
      return std::vector<double>{all.largest, all.size, all.alone, all.per_rod};
    });
    result.scalars["largest_cluster"] = numbers[0];
    result.scalars["cluster_size"] = numbers[1];
    result.scalars["rods_alone"] = numbers[2];
    result.scalars["clusters_per_rod"] = numbers[3];
  }
  void save(StateWriter& writer) const override {
    series_.save(writer);
    statistics_.save(writer);
  }
  void restore(StateReader& reader) override {
    series_.restore(reader);
    statistics_.restore(reader);
  }

 private:
  static void put_points(Reduction& result, const std::string& path, const std::vector<Scalar>& points) {
    put(result, path, "", std::vector<analysis::Estimate>(points.begin(), points.end()));
  }

  std::vector<analysis::RodAxis> axes_;
  analysis::ClusterRule rule_;
  analysis::Region region_;
  int n_octaves_;  // that sizes can be in
  analysis::ClusterSeries series_;
  analysis::Blocked<analysis::ClusterStatistics> statistics_{analysis::ClusterStatistics()};
};

}  // namespace

MeasurementKind clusters_kind() {
  return {
      .name = "clusters",
      .sources = "clusters, segment_distance, region",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        const scene::MeasureClusters& settings = *context.plan.clusters;
        const System& system = context.plan.system;
        const analysis::ClusterRule rule{
            .distance = settings.distance_for(system.rod.mid_diameter),
            .angle = system.rod.has_axis() ? settings.angle * kPi / 180 : kPi / 2,
        };
        const auto axes = context.of_rods([](const Species& rod) {
          return analysis::RodAxis{rod.tail.length, rod.head.length};
        });
        return std::make_unique<MeasuredClusters>(axes, rule, analysis::Region(system.box(), system.walls),
                                                  system.n_rods);
      },
      .arrays =
          {
              {"time_s", "times of the next two; of more than 65,536 samples, each point is a mean of several"},
              {"largest", "share of the rods that are in the largest cluster"},
              {"size", "number of rods in the cluster of a rod, mean over rods"},
              {"sizes/size",
               "smallest of the sizes that are counted together: those below the next, which is twice it"},
              {"sizes/rods", "share of the rods that are in clusters of these sizes", kWithError},
              {"sizes/density", "n(s): clusters of one size over rods, mean over these sizes", kWithError},
          },
      .numbers =
          {
              {"largest_cluster", "share of the rods that are in the largest cluster"},
              {"cluster_size", "number of rods in the cluster of a rod, mean over rods: ⟨s²⟩/⟨s⟩"},
              {"rods_alone", "share of the rods without a neighbour"},
              {"clusters_per_rod", "number of clusters over number of rods; a rod alone is a cluster"},
          },
  };
}

}  // namespace shaken::run
