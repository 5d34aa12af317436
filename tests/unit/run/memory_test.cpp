// The estimate of scene/keys/observables.h against what a run takes, with every allocation of this process counted.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "base/scratch_folder.h"
#include "run/loop/loop.h"
#include "scene/keys/observables.h"
#include "scene/load.h"

namespace {

std::atomic<std::int64_t> g_bytes{0}, g_peak{0};

void* counted(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  const auto held = g_bytes += static_cast<std::int64_t>(malloc_usable_size(memory));
  std::int64_t peak = g_peak;
  while (held > peak && !g_peak.compare_exchange_weak(peak, held)) {
  }
  return memory;
}

void release(void* memory) {
  if (memory != nullptr) g_bytes -= static_cast<std::int64_t>(malloc_usable_size(memory));
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return counted(std::malloc(size)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto to = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(to, (size + to - 1) / to * to));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace shaken::run {
namespace {

scene::RunPlan plan_of(const std::vector<std::string>& settings) {
  const auto plan = scene::load_scene(
      R"({"rods": {"length": 2.5, "count": 100}, "box": {"side": 30}, "stream": null,
          "time": {"step": "20 us", "steady": 0, "measure": "20 ms"}})",
      "s.json", settings);
  EXPECT_TRUE(plan) << to_string(plan.error());
  return *plan;
}

/// Bytes that the run adds to those in use, at its peak.
double peak_of_run(const scene::RunPlan& plan) {
  const ScratchFolder folder;
  RunOptions options;
  options.directory = folder.path();
  const std::int64_t before = g_bytes;
  g_peak = before;
  const RunOutcome outcome = run(plan, options);
  EXPECT_EQ(outcome.state, RunState::kDone) << outcome.message;
  return static_cast<double>(g_peak - before);
}

struct Case {
  const char* name;
  std::vector<std::string> settings;

  friend void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }
};

class MemoryOfARun : public ::testing::TestWithParam<Case> {};

TEST_P(MemoryOfARun, IsEstimatedWithinAFactorOfTwo) {
  const scene::RunPlan plan = plan_of(GetParam().settings);
  scene::RunPlan bare = plan;
  static_cast<scene::MeasurePlan&>(bare) = {};
  const double measured = peak_of_run(plan) - peak_of_run(bare);
  const double estimate = scene::peak_of(scene::measure_memory(plan));
  EXPECT_GT(measured, 2e6) << "too little to tell";
  EXPECT_LT(measured / estimate, 2) << measured << " bytes, estimated " << estimate;
  EXPECT_GT(measured / estimate, 0.5) << measured << " bytes, estimated " << estimate;
}

INSTANTIATE_TEST_SUITE_P(
    Each, MemoryOfARun,
    ::testing::Values(
        Case{"order", {"measure={\"order\": {\"every\": \"20 us\"}}", "time.measure=1.2", "rods.count=2"}},
        Case{"angles", {"measure={\"angles\": {\"every\": \"100 us\", \"bins\": 10000}}"}},
        Case{"tilt", {"measure={\"tilt\": {\"every\": \"100 us\", \"bins\": 10000}}"}},
        Case{"defects_of_a_fine_grid", {"measure={\"defects\": {\"every\": \"10 ms\", \"grid\": 0.05}}"}},
        Case{"g2", {"measure={\"g2\": {\"every\": \"100 us\", \"bins\": 10000}}"}},
        Case{"msd_of_many_rods", {"measure={\"msd\": {\"every\": \"20 us\"}}", "rods.count=2000", "box.side=120"}},
        Case{"rotation_of_many_rods",
             {"measure={\"rotation\": {\"every\": \"20 us\"}}", "rods.count=4000", "box.side=160"}},
        Case{"velocity_with_a_long_window",
             {"measure={\"velocity\": {\"every\": \"20 us\", \"window\": \"15 ms\"}}", "rods.count=1000",
              "box.side=90"}},
        Case{"rods", {"measure={\"rods\": {\"every\": \"20 us\", \"count\": 100}}", "time.measure=0.1"}},
        Case{"pairs", {"measure={\"pairs\": {\"every\": \"200 us\", \"bins\": 201}}"}},
        Case{"layers", {"measure={\"layers\": {\"every\": \"200 us\"}}"}},
        Case{"polar", {"measure={\"polar\": {\"every\": \"20 us\"}}", "time.measure=1.2", "rods.count=2"}},
        Case{"temperatures",
             {"measure={\"temperatures\": {\"every\": \"20 us\"}}", "time.measure=1.2", "rods.count=2"}},
        Case{"scattering_of_many_rods",
             {"measure={\"scattering\": {\"every\": \"20 us\"}}", "rods.count=2000", "box.side=120"}},
        Case{"van_hove", {"measure={\"van_hove\": {\"every\": \"20 us\", \"lag\": \"200 us\", \"bins\": 2000}}"}},
        Case{"flow", {"measure={\"flow\": {\"every\": \"100 us\", \"bins\": 10000}}"}},
        Case{"clusters", {"measure={\"clusters\": {\"every\": \"20 us\"}}", "time.measure=1.2", "rods.count=2"}},
        Case{"collisions", {"measure={\"collisions\": {\"every\": \"20 us\"}}", "time.measure=1.2", "rods.count=2"}},
        Case{"stress", {"measure={\"stress\": {\"every\": \"20 us\"}}", "time.measure=1.2", "rods.count=2"}},
        Case{"drift", {"measure={\"drift\": {\"every\": \"20 us\"}}", "time.measure=1.2", "rods.count=2"}},
        Case{"mixing", {"measure={\"mixing\": {\"every\": \"100 us\", \"bins\": 5000}}", "rods_2.count=9"}},
        Case{"defect_maps", {"measure={\"defect_maps\": {\"every\": \"200 us\", \"bins\": 61}}"}},
        Case{"density", {"measure={\"density\": {\"every\": \"20 us\", \"duration\": \"40 us\", \"grid\": 1}}"}},
        Case{"several",
             {"measure={\"order\": {}, \"g2\": {\"every\": \"100 us\", \"bins\": 5000}, \"pairs\": "
              "{\"every\": \"200 us\"}, \"rods\": {\"every\": \"20 us\", \"count\": 100}}"}}),
    [](const auto& each) { return each.param.name; });

TEST(MemoryOfTheListOfDefects, IsThatOfDisorderedRodsAtMost) {
  const scene::RunPlan plan =
      plan_of({"measure={\"defects\": {\"every\": \"20 us\", \"list\": true, \"smoothing\": 1, \"grid\": 0.5}}",
               "rods.count=200", "rods.start=random"});
  const double estimate = scene::peak_of(scene::measure_memory(plan));
  scene::RunPlan bare = plan;
  bare.defects.reset();
  const double measured = peak_of_run(plan) - peak_of_run(bare);
  EXPECT_GT(measured, 1e6);
  EXPECT_LT(measured, 2 * estimate);
}

}  // namespace
}  // namespace shaken::run
