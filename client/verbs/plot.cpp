// `shaken plot`: python/shaken/tables/plot.py.
#include "client/verbs/in_python.h"
#include "client/verbs/verbs.h"

namespace shaken::client {

std::unique_ptr<Verb> make_plot() {
  return handed_on(
      "tables", {"plot"},
      {"plot", kResultsGroup, "Figures of a sweep, a job or a run directory",
       "  shaken plot                   the newest sweep, into plots-s3/\n"
       "  shaken plot s3 -o figures     S(t), S against the swept parameter, P(theta), tilt, G2, MSD\n"
       "  shaken plot s3 --x rods.area_fraction --y theta_m_deg -o theta.pdf\n"
       "  shaken plot s3 --where 'rods.length=4.5 and box.gap<2mm' --width 183mm\n"
       "  shaken plot s3 --format svg   as PDF or SVG instead of PNG\n"
       "  shaken plot s3 --map -o map.png   the last frames of its runs, by one or two swept numbers\n"
       "  shaken plot sim seen paper.csv   a run, an experiment and curves of a paper over each other\n"
       "  shaken plot sim seen -o one.pdf  the same, as panels of one figure\n"
       "  shaken plot runs/first        what `shaken run` has left there"},
      [](Arguments& arguments) {
        arguments.list(
            "ID",
            "A sweep, a job, a run directory or a folder of runs; the newest sweep if left out. Or several run "
            "directories and tables of curves, to be drawn over each other",
            Names::kRun);
        arguments.option("--x", "PATH",
                         "One figure: against this parameter or field; the longest swept one if left out",
                         Names::kField);
        arguments.option("--y", "FIELD",
                         "One figure: of this field of `results --csv`, or scalar; order.mean if left out",
                         Names::kField);
        arguments.repeatable("-w,--where", "CONDITION",
                             "Only points that match, as of `results`; repeatable, all must hold");
        arguments.flag("--map", "One figure: the last frames of the runs over the first one or two swept numbers");
        arguments.option(
            "-o,--out", "DIR",
            "Where to write; plots-ID if left out. Of one figure also a file, and of runs all of them in one",
            Names::kFolder);
        arguments.option("--format", "png|pdf|svg", "png if left out; of one figure also by the suffix of --out",
                         Names::kAnything);
        arguments.option("--width", "89mm|120mm|183mm",
                         "A column, one and a half, or a page; as the panels need it if left out", Names::kAnything);
      });
}

}  // namespace shaken::client
