// `shaken results`: python/shaken/tables/results.py.
#include "client/verbs/in_python.h"
#include "client/verbs/verbs.h"

namespace shaken::client {

std::unique_ptr<Verb> make_results() {
  return handed_on(
      "tables", {"results"},
      {"results", kResultsGroup, "One line of numbers per job, or per point with --aggregate",
       "  shaken results                               the newest sweep\n"
       "  shaken results from-the-cluster/             the runs in a folder: no daemon is asked\n"
       "  shaken results s3 --aggregate                replicas as mean and standard error\n"
       "  shaken results s3 --where 'rods.length=4.5mm and order.mean>0.5'\n"
       "  shaken results s3 --where 'not state=done or order.sem>0.01' --csv\n"
       "  shaken results s3 --columns job,order.mean,theta_m_deg\n"
       "  shaken results s3 --csv > order.csv          every field of every summary: the names for --columns\n"
       "Quote conditions, so that the shell does not interpret < > ( ). --where takes and, or, not, ( ), and = != < "
       "<= > >= with\n"
       "any key of the scene or number of the summary to their left: `--csv` shows their names. A comparison is "
       "false\nfor runs that lack the name.\n"
       "A value marked ~ is of a run that is still relaxing, one marked ? of a run that is not known to be steady:\n"
       "run them longer. With --aggregate, (2) behind a mean says that only 2 runs have a value."},
      [](Arguments& arguments) {
        arguments.optional("ID", "A sweep (id or name), a job, or a folder of runs; the newest sweep if left out",
                           Names::kRun);
        arguments.repeatable("-w,--where", "CONDITION",
                             "Only rows that match, e.g. 'order.mean>0.5 and box.gap<2mm'; repeatable, all must hold");
        arguments.flag("-a,--aggregate", "Replicas of a point as mean and standard error");
        arguments.option("--columns", "FIELD,FIELD", "These fields only, as a table or with --csv", Names::kAnything);
        arguments.flag("--csv", "All fields as CSV");
        arguments.flag("--json", "The daemon's rows, or the aggregated ones, as JSON");
      });
}

}  // namespace shaken::client
