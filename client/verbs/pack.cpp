// `shaken pack` and `shaken unpack`: python/shaken/packed.py.
#include "client/verbs/in_python.h"
#include "client/verbs/verbs.h"

namespace shaken::client {

std::unique_ptr<Verb> make_pack() {
  return handed_on("tables", {"pack"},
                   {"pack", kResultsGroup, "Runs in one file, to hand on",
                    "  shaken pack 1f0c                  a run: scene, numbers and curves, into 1f0c59d1.tar.xz\n"
                    "  shaken pack s3 -o phases.tar.xz   the runs of a sweep that are done\n"
                    "  shaken pack s3 --frames           with their recorded frames\n"
                    "  shaken pack from-the-cluster/     the runs in a folder"},
                   [](Arguments& arguments) {
                     arguments.list("ID", "A sweep, a job, or a folder of runs", Names::kRun);
                     arguments.option("-o,--out", "FILE", "Where to write; named after the first if left out",
                                      Names::kFile);
                     arguments.flag("--frames", "With trajectory.h5, for pictures and films");
                     arguments.flag("--json", "Print JSON");
                   });
}

std::unique_ptr<Verb> make_unpack() {
  return handed_on("tables", {"unpack"},
                   {"unpack", kResultsGroup, "The runs of a file of `shaken pack`, into a folder",
                    "  shaken unpack phases.tar.xz       into phases/; then `shaken results phases/`\n"
                    "  shaken unpack phases.tar.xz -o runs"},
                   [](Arguments& arguments) {
                     arguments.list("FILE", "What `shaken pack` has written", Names::kFile);
                     arguments.option("-o,--out", "DIR", "Where to write; named after the file if left out",
                                      Names::kFolder);
                     arguments.flag("--json", "Print JSON");
                   });
}

}  // namespace shaken::client
