// The text of a sweep file: every point that is taken can be queued and read again.
#include "scene/sweeps/sweep.h"

#include "scene/canonical.h"
#include "scene/load.h"
#include "tests/fuzz/fuzz_target.h"

using namespace shaken;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto sweep = scene::load_sweep(fuzz::text_of(data, size), "fuzz.json");
  if (!sweep) {
    fuzz::promise(!sweep.error().empty(), "a refusal says why");
    return 0;
  }
  fuzz::promise(!sweep->points.empty(), "a sweep has points");
  for (const scene::SweepPoint* point : {&sweep->points.front(), &sweep->points.back()}) {
    (void)point->parameters.dump();
    fuzz::promise(static_cast<bool>(scene::load_scene(scene::to_json(point->plan).dump(), "again.json")),
                  "a point's canonical scene is taken");
  }
  return 0;
}
