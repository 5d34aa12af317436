// `shaken export`: python/shaken/tables/export.py.
#include "client/verbs/in_python.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Export : public InPython {
 public:
  VerbInfo info() const override {
    return {"export", kResultsGroup, "A run's rods or curves as files of other programs: OVITO, VMD, tables",
            "  shaken export 1f0c --format gsd                      -> 1f0c5e2a.gsd: OVITO draws the rods as they are\n"
            "  shaken export runs/first -o first.extxyz             text, one line a rod: OVITO, ASE\n"
            "  shaken export runs/first --format xyz -o -           text, one line a bead, to stdout: VMD, MDAnalysis\n"
            "  shaken export runs/first --format gsd --from 2s --to 4s --every 10\n"
            "  shaken export runs/first --format extxyz --last      the last frame only\n"
            "  shaken export runs/first --list                      the names for --observable\n"
            "  shaken export runs/first --format csv --observable msd\n"
            "  shaken export runs/first --format csv --observable summary     all numbers with their errors"};
  }

  void declare_options(Arguments& arguments) override {
    arguments.required("RUN", run_, "A job, by the beginning of its id, or a run directory", Names::kJobOrFolder);
    arguments.option("--format", "extxyz|gsd|xyz|csv", "By the suffix of --out if left out");
    arguments.option("-o,--out", "FILE", "Where to write; - is stdout. Named after the run if left out", Names::kFile);
    arguments.option("--from", "TIME", "Frames: none earlier, e.g. 2s");
    arguments.option("--to", "TIME", "Frames: none later");
    arguments.option("--every", "N", "Frames: of those, the first and every Nth after it");
    arguments.flag("--last", "Frames: of those, the last one only");
    arguments.repeatable("--observable", "NAME", "csv: a group or an array of observables.h5, or summary; repeatable");
    arguments.flag("--list", "Print the names for --observable");
  }

  ExitCode run(const Context& context) override {
    return go_on(context, "tables", {"export", root_option(context), "--run=" + run_});
  }

 private:
  std::string run_;
};

}  // namespace

std::unique_ptr<Verb> make_export() { return std::make_unique<Export>(); }

}  // namespace shaken::client
