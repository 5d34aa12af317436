#include <string>

#include "base/program.h"
#include "run/files/version.h"
#include "server/slurm/task.h"

namespace {

constexpr const char* kFooter =
    R"(Slurm starts it for shakend, as what a job array is made of; there is no need to start it by hand. It reads the
number of its task from SLURM_ARRAY_TASK_ID, does the runs that FOLDER/batch.json lists for it, and writes into
FOLDER/NUMBER.json how each of them ended. On SIGUSR1, which Slurm sends ahead of the end of its time, on SIGTERM, and
for a run that FOLDER/NUMBER.stop names, it lets the run that is at work write a checkpoint and end.

Exit codes: 0 every run has ended, or the time is over, 1 failed, 2 bad input, 143 the task was taken away.)";

}  // namespace

int main(int argc, char** argv) {
  shaken::Program app("shaken-task", "Does one task of a batch of runs, one after the other, on a node of a cluster.",
                      kFooter);
  std::string folder;
  app.set_version_flag("--version", shaken::run::version());
  app.add_option("FOLDER", folder, "Of the batch, below slurm/ of the daemon's root")->type_name("DIR")->required();
  return app.run(argc, argv, [&] { return shaken::server::slurm::do_task({folder}); });
}
