#include "run/loop/replay.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iostream>

#include "base/program.h"
#include "run/files/directory.h"
#include "run/loop/saved_run.h"
#include "run/loop/start_state.h"
#include "scene/canonical.h"
#include "sim/simulation.h"

namespace shaken::run {
namespace {

std::string vector_text(const Vec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x(), v.y(), v.z()); }

}  // namespace

Result<Replay> replay(const std::filesystem::path& root) {
  const RunDirectory directory{root};
  if (!std::filesystem::is_directory(root)) return Error{root.string() + ": there is no such directory"};
  if (!std::filesystem::exists(directory.scene())) return Error{root.string() + " holds no run (no scene.json)"};
  if (!std::filesystem::exists(directory.trouble())) {
    return Error{root.string() + " holds no trouble.json: its run has met no numerical trouble"};
  }
  TroubleReport recorded = SHAKEN_TRY(read_trouble(directory.trouble()));
  const scene::RunPlan plan = SHAKEN_TRY(read_plan(directory));
  const NumericalTrouble& trouble = recorded.trouble;
  Result<Simulation> simulation = resume_last(directory, scene::run_id(plan), plan.system, trouble.tick);
  if (!simulation) simulation = start_simulation(plan, root);
  if (!simulation) return simulation.error();

  Replay replay{recorded, simulation->tick(), {}, {}};
  replay.met = simulation->advance_to(trouble.tick - 1);
  if (replay.met) return replay;  // earlier than it was
  std::vector<int> rods;
  for (const int rod : trouble.rods) {
    if (rod >= 0 && rod < plan.system.n_all_rods()) rods.push_back(rod);
  }
  replay.before = look_closely(simulation->world(), simulation->tick(), rods);
  replay.met = simulation->advance_to(trouble.tick);
  return replay;
}

std::string as_text(const Replay& replay, double dt) {
  std::string text = fmt::format("recorded: {}\n", describe(replay.recorded.trouble, dt));
  text += replay.started_at > 0 ? fmt::format("from the checkpoint at tick {}", replay.started_at)
                                : std::string("from the beginning");
  text += fmt::format("; at tick {}, base at {:.6g} mm, moving at {:.6g} mm/s:\n", replay.before.tick,
                      replay.before.plates.base, replay.before.plates.velocity);
  for (const CloseUp::Rod& rod : replay.before.rods) {
    text +=
        fmt::format("  rod {}{}\n    position {} mm, director {}\n    velocity {} mm/s, turning at {} rad/s\n", rod.rod,
                    rod.concerned ? "" : " (neighbour)", vector_text(rod.pose.position), vector_text(rod.pose.director),
                    vector_text(rod.motion.velocity), vector_text(rod.motion.angular_velocity));
  }
  for (const CloseUp::Contact& contact : replay.before.contacts) {
    const std::string other = contact.other >= 0 ? fmt::format("bead {} of rod {}", contact.other_bead, contact.other)
                                                 : std::string("the ") + surface_name(contact.other);
    text += fmt::format("  bead {} of rod {} is {:.6g} mm deep in {}, {} at {:.6g} mm/s\n", contact.bead, contact.rod,
                        contact.overlap, other, contact.approach > 0 ? "approaching" : "parting",
                        std::abs(contact.approach));
  }
  if (replay.before.contacts.empty()) text += "  no contacts at this tick\n";
  text += fmt::format("now:      {}\n", replay.met ? describe(*replay.met, dt) : "no trouble at this tick");
  text += replay.same() ? "the same trouble at the same tick\n"
                        : "NOT the same: this program, or this machine, differs from the one that ran it\n";
  return text;
}

int replay_command(int argc, char** argv) {
  Program app("shaken-worker replay", "Meets a run's numerical trouble once more and shows the rods concerned.",
              "Exit codes: 0 the same trouble came back, 1 it did not, 2 bad input.");
  std::string directory;
  bool json = false;
  app.add_option("DIR", directory, "Run directory with a trouble.json")->required();
  app.add_flag("--json", json, "Print JSON");
  return app.run(argc, argv, [&] {
    const Replay replayed = value_or_fail(replay(directory), ExitCode::kBadInput);
    const scene::RunPlan plan = value_or_fail(read_plan(RunDirectory{directory}), ExitCode::kBadInput);
    if (json) {
      const auto trouble_json = [](const NumericalTrouble& trouble) {
        return nlohmann::ordered_json{{"tick", trouble.tick}, {"rods", trouble.rods}, {"what", trouble.what}};
      };
      nlohmann::ordered_json out{{"recorded", trouble_json(replayed.recorded.trouble)},
                                 {"started_at_tick", replayed.started_at},
                                 {"before", to_json(replayed.before)},
                                 {"met", nullptr},
                                 {"same", replayed.same()}};
      if (replayed.met) out["met"] = trouble_json(*replayed.met);
      std::cout << out.dump(2) << "\n";
    } else {
      std::cout << as_text(replayed, plan.system.dt);
    }
    return replayed.same() ? ExitCode::kOk : ExitCode::kFailed;
  });
}

}  // namespace shaken::run
