// The text of a scene file: what is taken, reads as itself once more.
#include "scene/canonical.h"
#include "scene/keys/observables.h"
#include "scene/load.h"
#include "scene/remarks.h"
#include "tests/fuzz/fuzz_target.h"

using namespace shaken;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto plan = scene::load_scene(fuzz::text_of(data, size), "fuzz.json");
  if (!plan) {
    fuzz::promise(!plan.error().empty(), "a refusal says why");
    return 0;
  }
  (void)scene::remarks(*plan);
  fuzz::promise(scene::peak_of(scene::measure_memory(*plan)) >= 0, "memory is a number");
  const auto again = scene::load_scene(scene::to_json(*plan).dump(), "again.json");
  fuzz::promise(static_cast<bool>(again), "the canonical scene is taken");
  fuzz::promise(scene::run_id(*again) == scene::run_id(*plan), "the canonical scene is the same run");
  return 0;
}
