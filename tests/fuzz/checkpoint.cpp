// Saved states, behind the hash that guards a checkpoint's file: of a world (first byte '0'), or of the measurement
// that the first byte names ('1', '2', ... in the order of the registry). What is taken is saved again as the same
// bytes.
#include "sim/checkpoint.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "run/measure/measurements.h"
#include "scene/keys/observables.h"
#include "scene/load.h"
#include "sim/simulation.h"
#include "tests/fuzz/fuzz_target.h"

using namespace shaken;

namespace {

/// A scene where everything is measured: as here, or by default.
constexpr const char* kScene = R"({
  "rods": {"length": "2.5 mm", "count": 8}, "box": {"side": "8 mm"}, "time": {"steady": 0, "measure": 1},
  "measure": {"angles": {"bins": 4}, "tilt": {"bins": 4}, "defects": {"list": true}, "g2": {"bins": 4},
              "pairs": {"bins": 3}, "structure": {"waves": 4}, "van_hove": {"bins": 4}, "flow": {"bins": 4},
              "mixing": {"bins": 4}, "defect_maps": {"bins": 2}}})";

const scene::RunPlan& plan() {
  static const scene::RunPlan loaded = [] {
    auto text = nlohmann::json::parse(kScene);
    for (const scene::Observable& one : scene::observables())
      text["measure"].emplace(one.name, nlohmann::json::object());
    const auto scene = scene::load_scene(text.dump(), "fuzz.json");
    fuzz::promise(static_cast<bool>(scene), "the target's own scene is one");
    return *scene;
  }();
  return loaded;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto bytes = std::as_bytes(std::span(data, size)).subspan(1);
  if (data[0] == '0') {
    if (const auto world = restore_checkpoint(plan().system, bytes)) {
      const auto saved = save_checkpoint(*world);
      const bool is_former = bytes[7] != saved[7];  // of a format that is read, but no longer written
      const auto again = restore_checkpoint(plan().system, saved);
      fuzz::promise(is_former || std::ranges::equal(saved, bytes), "a world is saved as it was read");
      fuzz::promise(again && std::ranges::equal(save_checkpoint(*again), saved), "a world is read as it was saved");
    }
    return 0;
  }
  const auto kinds = run::measurement_kinds();
  const auto kind = static_cast<std::size_t>(static_cast<std::uint8_t>(data[0] - '1')) % kinds.size();
  run::Measurements measurements(run::only(plan(), kinds[kind]));
  if (measurements.restore(bytes)) {
    fuzz::promise(std::ranges::equal(measurements.save(), bytes), "measurements are saved as they were read");
    (void)measurements.reduce(1.0);
  }
  return 0;
}
