// The options of `shaken figures`, for help and completion; the Python package does the work (shaken/study/app.py).
#include "client/verbs/in_python.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

/// What completion offers: the paper's numbers, and the names of all figures (python/shaken/study/figures.py).
constexpr const char* kFigures =
    "2|3|4|5|6|7|8|9|10|11|12|13|14|start|order|order-statistics|g2|g2-map|distances|layers|diffusion|tilt|paths|"
    "memory|rotation|defects|layer-trends|larger-box|ends|gap|taper|steady|shaking|scaling|elasticity|diffusion-more|"
    "melting|fluctuations|equilibrium|model|movies|accuracy";

}  // namespace

std::unique_ptr<Verb> make_figures() {
  return handed_on(
      "study", {},
      {"figures", kResultsGroup, "The figures of Sharma & Soni (2024), and some beyond: runs, archives, draws, judges",
       "  shaken figures                        everything at desk scale, into figures-desk/\n"
       "  shaken figures --list                 what there is, and the runs that each needs\n"
       "  shaken figures 3 8 layer-trends       the phase diagram and the layers; numbers are the paper's\n"
       "  shaken figures --budget 10h           ten CPU-hours of it, in order of worth; what is open is said\n"
       "  shaken figures --scale tiny           minutes: to see that all is there\n"
       "  shaken figures --scale paper --dry-run --cores 8   what the paper's sizes would cost\n"
       "  shaken --root /shared/me figures --scale paper --executor slurm --partition long --time 24h\n"
       "                                        everything at the paper's size, in Slurm (docs/cluster.md)\n"
       "  shaken figures --scale paper --executor slurm --cores 64 --plan plan.md\n"
       "                                        only a plan for a computing centre, and the sweeps beside it\n"
       "  shaken figures --draw-only --archive docs/archive   from an archive of runs, on any machine\n"
       "Stop it at any time: the same command goes on where it stopped. `shaken watch` and `shaken status` work\n"
       "meanwhile. What it will cost is told before it starts, and asked on a terminal. Each run that is done goes "
       "into the archive, a folder of small files that can be copied and merged. Beside each picture lie its data "
       "as CSV."},
      [](Arguments& arguments) {
        arguments.list("FIGURE", "A number of the paper, 2 to 14, or a name of --list; all if left out", kFigures);
        arguments.option("--scale", "tiny|desk|paper", "Size of the runs; desk if left out");
        arguments.option("--budget", "TIME", "CPU time after which it stops: 10h; it runs everything if left out");
        arguments.option("--archive", "DIR", "Archive of finished runs; OUT/archive if left out", Names::kFolder);
        arguments.option("-o,--out", "DIR", "Where to draw; figures-SCALE if left out", Names::kFolder);
        arguments.option("--format", "png|pdf|svg", "png if left out", Names::kAnything);
        arguments.option("--width", "89mm|120mm|183mm", "Width of the figures; 183mm if left out", Names::kAnything);
        arguments.option("--configs", "DIR", "Folder that holds the sweeps of the sets", Names::kFolder);
        arguments.flag("--list", "List the figures and the sets that they need, and do nothing");
        arguments.flag("--dry-run", "Say what is open and what it would cost, and start nothing");
        arguments.flag("--collect", "First archive every run of the daemon that is done");
        arguments.flag("--draw-only", "Run nothing: draw from the archive");
        arguments.option("--cores", "N", "Cores that a plan is made for", Names::kAnything);
        arguments.option(
            "--plan", "FILE",
            "Start nothing: write what a computing centre wants to know (Markdown), and the sweeps beside it",
            Names::kFile);
        arguments.option("--executor", "local|slurm", "Where the runs run; as the daemon has it if left out");
        arguments.option("--partition", "NAME", "In Slurm: partition, or several with commas", Names::kAnything);
        arguments.option("--account", "NAME", "In Slurm: account that is charged", Names::kAnything);
        arguments.option("--time", "TIME", "In Slurm: wall time of a task (4h); what is left goes on in another",
                         Names::kAnything);
        arguments.option("--memory", "SIZE", "In Slurm: memory of a task (2G)", Names::kAnything);
        arguments.option("--runs-per-task", "N", "In Slurm: runs that a task does one after the other",
                         Names::kAnything);
        arguments.repeatable("--slurm-option", "OPTION", "In Slurm: any option of sbatch; repeatable");
        arguments.repeatable(
            "--report", "FILE",
            "Write what the marks of this Markdown file ask for between them (docs/validation.md); repeatable",
            Names::kFile);
        arguments.flag("-y,--yes", "Start without asking, also on a terminal");
        arguments.flag("--json", "Print what was made, and the verdicts, as JSON");
      });
}

}  // namespace shaken::client
