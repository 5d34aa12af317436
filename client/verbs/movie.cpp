// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "base/process.h"
#include "client/target.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Movie : public Verb {
 public:
  VerbInfo info() const override {
    return {"movie", kResultsGroup, "Film or picture of a job: rods coloured by angle, defects marked",
            "  shaken movie 1f0c                            -> 1f0c5e2a.mp4, from the recorded trajectory\n"
            "  shaken movie runs/first -o first.mp4         of a run directory\n"
            "  shaken movie 1f0c --frame last               -> 1f0c5e2a.png, one frame\n"
            "  shaken movie 1f0c --frame 120 -o fig3.png\n"
            "  shaken movie 1f0c --live -o now.png          the running job's present state, from LCM"};
  }

  void declare(Arguments& arguments) override {
    arguments.required("JOB", id_, "A job, by the beginning of its id, or a run directory", Names::kRun);
    arguments.option("-o,--out", out_, "FILE", "Where to write; named after the job if left out", Names::kFile);
    arguments.option("--frame", frame_, "N|last", "One frame as a PNG instead of a film");
    arguments.flag("--live", live_, "The present state of a running job as a PNG");
    arguments.option("--lcm-url", lcm_url_, "URL", "With --live: the bus; the daemon's if left out");
  }

  ExitCode run(const Context& context) override {
    if (live_ && !frame_.empty()) throw Failure(ExitCode::kBadInput, "--live and --frame exclude each other");
    if (!frame_.empty() && frame_ != "last" && frame_.find_first_not_of("0123456789") != std::string::npos) {
      throw Failure(ExitCode::kBadInput, fmt::format("--frame takes a number from 0 or 'last', not '{}'", frame_));
    }
    std::string directory = id_;
    std::string name = std::filesystem::weakly_canonical(id_).filename().string();
    std::string job_id;
    if (!is_run_directory(id_)) {
      ApiClient session(context.root());
      const Json job = find_job(session, id_);
      job_id = job.at("id").get<std::string>();
      directory = job.at("directory").get<std::string>();
      name = short_id(job_id);
      const std::string state = text_of(job, "state");
      if (live_ && state != "running" && state != "stopping") {
        throw Failure(ExitCode::kFailed,
                      fmt::format("job {} is {}: nothing of it is live. `shaken movie {} --frame last` draws its last "
                                  "recorded frame",
                                  short_id(job_id), state, id_));
      }
      if (live_ && lcm_url_.empty()) lcm_url_ = text_of(session.get("/v1/status").at("lcm"), "url");
    } else if (live_) {
      throw Failure(ExitCode::kBadInput, "--live takes the ID of a running job, not a directory");
    }

    const std::string render = sibling_program("shaken-render").string();
    if (live_) become({render, "live", job_id, "--lcm-url", lcm_url_, "-o", out_or(name + ".png")});
    if (!frame_.empty()) become({render, "picture", directory, "--frame", frame_, "-o", out_or(name + ".png")});
    become({render, "movie", directory, "-o", out_or(name + ".mp4")});
  }

 private:
  std::string out_or(const std::string& file) const { return out_.empty() ? file : out_; }

  std::string id_;
  std::string out_;
  std::string frame_;
  bool live_ = false;
  std::string lcm_url_;
};

}  // namespace

std::unique_ptr<Verb> make_movie() { return std::make_unique<Movie>(); }

}  // namespace shaken::client
