#include <malloc.h>

#include <string_view>

#include "base/program.h"
#include "run/files/foreign_file.h"
#include "run/files/version.h"
#include "run/import/import_run.h"
#include "run/loop/replay.h"
#include "run/recorded/measure_command.h"
#include "run/worker/worker.h"

namespace {

using namespace shaken;

constexpr const char* kFooter = R"(Examples:
  shaken-worker quickstart.json --out runs/quick
  shaken-worker quickstart.json --out runs/long -s time.measure="60 s" -s time.seed=7 --no-lcm
  shaken-worker quickstart.json --out runs/quick      goes on from the last checkpoint, or says that it is done
  shaken-worker quickstart.json --probe cost.json     runs nothing, but tells what the run would cost
  shaken-worker replay runs/wild                      meets a failed run's numerical trouble again
  shaken-worker import rods.csv --scene scene.json    makes a run of the rods in a file
  shaken-worker measure runs/first --out wide         measures the frames of a run anew

Exit codes: 0 done, 1 failed, 2 bad input, 97 no room on the disk,
98 an error of the system that may pass, 99 stopped by a signal after a checkpoint.)";

void describe(CLI::App& app, run::WorkerOptions& options) {
  app.set_version_flag("--version", run::version());
  app.add_option("SCENE", options.scene, "Scene file (JSON)")->required();
  app.add_option("--out", options.out, "Run directory; made if it is not there")->type_name("DIR");
  app.add_option("-s,--set", options.settings, "Change one value of the scene")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  app.add_option("--job-id", options.job_id, "Name in live messages; the run's hash if not given")->type_name("ID");
  app.add_option("--sweep-id", options.sweep_id, "Sweep that the job belongs to, for the log")->type_name("ID");
  app.add_option("--label", options.label, "Swept parameters, shown by viewers")->type_name("TEXT");
  app.add_option("--lcm-url", options.lcm_url, "Where live state goes")->type_name("URL")->capture_default_str();
  app.add_flag("--no-lcm", options.no_lcm, "Send no live state");
  app.add_option("--threads", options.n_threads,
                 "Threads that share each tick: worth it from about 2,000 rods on. The results do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--checkpoint-every", options.checkpoint_every, "Wall-clock seconds between checkpoints")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--quiet", options.quiet, "Show warnings and errors only");
  CLI::Option* probe = app.add_option("--probe", options.probe,
                                      "Instead: step a piece of the run, and write what all of it would cost as JSON");
  probe->type_name("FILE");
  app.add_option("--probe-cpu", options.probe_cpu, "CPU time of the steps, about; 0 tells only what is on and off")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 3600.0))
      ->needs(probe)
      ->capture_default_str();
  app.add_option("--probe-from", options.probe_from, "Directory of a run of the same system, to start from its state")
      ->type_name("DIR")
      ->needs(probe);
}

}  // namespace

int main(int argc, char** argv) {
  // A frame's buffers come and go. Given back to the system each time, they cost a short run half of its CPU time. With
  // a threshold for the heap's end that for blocks of their own is 128 kB for ever, unless it is said, too.
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  if (argc > 1 && std::string_view(argv[1]) == "replay") return run::replay_command(argc - 1, argv + 1);
  if (argc > 1 && std::string_view(argv[1]) == "read") return run::read_command(argc - 1, argv + 1);
  if (argc > 1 && std::string_view(argv[1]) == "import") return run::import_command(argc - 1, argv + 1);
  if (argc > 1 && std::string_view(argv[1]) == "measure") return run::measure_command(argc - 1, argv + 1);
  Program app("shaken-worker", "Runs one scene from start to end in a run directory.", kFooter);
  run::stop_on_signals();
  run::WorkerOptions options;
  describe(app, options);
  return app.run(argc, argv, [&] { return run::work(options); });
}
