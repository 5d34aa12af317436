#include <fmt/format.h>

#include <filesystem>

#include "base/process.h"
#include "base/text.h"
#include "client/live/target.h"
#include "client/verbs/verbs.h"
#include "run/recorded/measure_command.h"

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
            "what needs more than the frames tell is left out. Both is said, and stands in summary.json."};
  }

  void declare(Arguments& arguments) override {
    arguments.required("RUN", asked_.file, "A job, by its id, a run directory, a trajectory.h5, or a table in CSV",
                       Names::kJobOrFolder);
    arguments.options_of([this](CLI::App& app) { run::declare(app, asked_); });
    arguments.hand_on(words_);
  }

  ExitCode run(const Context& context) override {
    std::string& run = asked_.file;
    std::error_code ignored;
    if (!std::filesystem::exists(run, ignored)) {
      if (run.find_first_of("./") != std::string::npos)  // no id of a job
        throw Failure(ExitCode::kBadInput, fmt::format("there is no {}", printable(run)));
      ApiClient session(context.root());
      run = find_job(session, run).at("directory").get<std::string>();
    }
    std::vector<std::string> command{sibling_program("shaken-worker").string(), "measure"};
    command.insert(command.end(), words_.begin(), words_.end());
    command.insert(command.end(), {"--", run});
    become(command);
  }

 private:
  run::MeasureOptions asked_;
  std::vector<std::string> words_;  ///< the same, as they were given
};

}  // namespace

std::unique_ptr<Verb> make_measure() { return std::make_unique<Measure>(); }

}  // namespace shaken::client
