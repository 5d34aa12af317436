#include <fmt/format.h>

#include <filesystem>

#include "base/process.h"
#include "base/text.h"
#include "client/live/target.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Measure : public Verb {
 public:
  VerbInfo info() const override {
    return {"measure", kResultsGroup, "Measure recorded frames anew, or the rods that an experiment has tracked",
            "  shaken measure runs/first -s measure.g2.bins=200           -> measured-1f0c5e2a/\n"
            "  shaken measure 1f0c -s measure.defects=true -o defects     of a job, by the beginning of its id\n"
            "  shaken measure first.h5 --scene others.json -o others      what that scene measures\n"
            "  shaken measure tracks.csv --scene dish.json --scale 0.05 --interval 20ms --flip-y -o seen\n"
            "  shaken plot seen                                           like the folder of any run\n"
            "\nA table has a row for each rod and frame, in columns as trackpy, TrackMate or ImageJ name them: a frame "
            "or a time, x, y and an angle; and, if it has them, an id, z and tilt. Its scene has the box, the rods' "
            "shape and what to measure. Samples are taken at frames alone, so periods become whole numbers of frames; "
            "what needs more than the frames tell is left out. Both is said, and stands in summary.json.",
            kExitCodesOfDaemon};
  }

  void declare(Arguments& arguments) override {
    arguments.required("RUN", run_, "A job, by its id, a run directory, a trajectory.h5, or a table in CSV",
                       Names::kJobOrFolder);
    arguments.option("--scene", "SCENE", "Measure what it measures; of frames, what their own does if left out",
                     Names::kFile);
    arguments.repeatable("-s,--set", "PATH=VALUE", "Change one value; of frames: of measure, or time.steady",
                         Names::kSetting);
    arguments.option("-o,--out", "DIR", "Folder of the results; measured-ID if left out", Names::kFolder);
    arguments.option("--scale", "MM", "Table: mm in one unit of its lengths, as a pixel");
    arguments.option("--interval", "TIME", "Table: time from frame to frame, e.g. 20ms; by its times if left out");
    arguments.option("--columns", "NAME=COLUMN,...", "Table: what columns are called, as in x=POSITION_X,angle=phi");
    arguments.flag("--flip-y", "Table: y is counted downwards, from the upper edge");
    arguments.flag("--wrap", "Table: put positions into the periodic box");
    arguments.option("--fill", "N", "Table: interpolate rods that are missed for up to N frames");
    arguments.flag("--complete", "Table: leave rods out that are not in every frame");
    arguments.flag("--degrees", "Table: angles are in degrees, as they are if nothing tells otherwise");
    arguments.flag("--radians", "Table: angles are in radians");
    arguments.flag("--json", "Print JSON, also of problems");
    arguments.hand_on(words_);
  }

  ExitCode run(const Context& context) override {
    std::error_code ignored;
    if (!std::filesystem::exists(run_, ignored)) {
      if (run_.find_first_of("./") != std::string::npos)  // no id of a job
        throw Failure(ExitCode::kBadInput, fmt::format("there is no {}", printable(run_)));
      ApiClient session(context.root());
      run_ = find_job(session, run_).at("directory").get<std::string>();
    }
    std::vector<std::string> command{sibling_program("shaken-worker").string(), "measure"};
    command.insert(command.end(), words_.begin(), words_.end());
    command.insert(command.end(), {"--", run_});
    become(command);
  }

 private:
  std::string run_;
  std::vector<std::string> words_;
};

}  // namespace

std::unique_ptr<Verb> make_measure() { return std::make_unique<Measure>(); }

}  // namespace shaken::client
