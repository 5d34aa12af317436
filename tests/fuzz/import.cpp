// Tables of rods from elsewhere: one state of them, and tracks.
#include <algorithm>
#include <cmath>

#include "run/import/place_rods.h"
#include "run/recorded/track_table.h"
#include "tests/fuzz/fuzz_target.h"

using namespace shaken;

namespace {

/// The same text as the tracks of an experiment.
void read_as_tracks(std::string_view text) {
  scene::RunPlan plan;
  plan.system.box_side = 16;
  for (const bool wraps : {false, true}) {
    run::TrackConventions conventions;
    conventions.interval = 0.02;
    conventions.filled = 2;
    conventions.wraps = conventions.only_complete = wraps;
    std::vector<keys::Problem> problems;
    const auto tracks = run::read_tracks(text, "tracks.csv", plan, conventions, problems);
    fuzz::promise(tracks.has_value() == problems.empty(), "tracks are read, or there is a reason");
    for (std::size_t i = 0; tracks && i < tracks->frames->n_frames(); ++i) {
      const auto frame = run::decode(*tracks->frames->frame(i), tracks->frames->header().cell.box);
      fuzz::promise(bool(frame), "a frame is one that a run could have");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  read_as_tracks(text);
  System system;
  system.rod = {.length = 2.5, .n_beads = 9};
  system.box_side = 16;
  system.added[0] = AddedRods{.rod = {.length = 1.5, .n_beads = 5}, .count = 1};
  std::vector<keys::Problem> problems;
  std::vector<std::string> remarks;
  const std::vector<run::ImportedRod> rods =
      run::read_csv_rods(text, "rods.csv", run::species_names(system), problems, remarks);
  const int n_lines =
      static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; })) + 1;
  for (const keys::Problem& problem : problems) {
    fuzz::promise(problem.line >= 0 && problem.line <= n_lines, "a problem has a line of the text, or none");
    fuzz::promise(!problem.message.empty(), "a refusal says why");
  }
  // as many as there are, but at least one of each: then little but their places can be wrong
  const auto n_second = std::count_if(rods.begin(), rods.end(), [](const auto& rod) { return rod.shape == 1; });
  system.n_rods = std::max(1, static_cast<int>(rods.size()) - static_cast<int>(n_second));
  system.added[0]->count = std::max(1, static_cast<int>(n_second));
  std::vector<keys::Problem> misplaced;
  const auto placed = run::place_rods(system, rods, "rods.csv", true, misplaced);
  fuzz::promise(placed.has_value() == misplaced.empty(), "rods have places, or there is a reason");
  if (!placed) return 0;
  for (const Flight& rod : placed->world.rods) {
    fuzz::promise(rod.position.x() >= 0 && rod.position.x() < system.box_side, "a centre lies in the box");
    fuzz::promise(std::abs(rod.director.norm() - 1) < 1e-9, "a director has length 1");
  }
  return 0;
}
