#include <fmt/format.h>

#include "base/process.h"
#include "client/live/api_client.h"
#include "client/live/target.h"
#include "client/picture_options.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Movie : public Verb {
 public:
  VerbInfo info() const override {
    return {"movie", kResultsGroup, "Film of a job, or of several side by side; or a job's present state",
            "  shaken movie 1f0c                            -> 1f0c5e2a.mp4, from the recorded trajectory\n"
            "  shaken movie runs/first -o first.mp4         of a run directory\n"
            "  shaken movie 1f0c --style defects --from 10s --to 20s --speed 0.1 --fps 30 --size 1920x1080\n"
            "  shaken movie 1f0c -o slide.gif --size 480x480 --bare     also .webm; FOLDER/: numbered frames\n"
            "  shaken movie 1f0c -o - --bare --size 720x720 | ffmpeg -f rawvideo -pix_fmt rgb24 -s 720x720 -i - x.mkv\n"
            "  shaken movie 1f0c 22ab -o both.mp4           two runs side by side, with one clock\n"
            "  shaken movie 1f0c --live -o now.png          the running job's present state, from LCM\n"
            "Styles, colours and style files: docs/pictures.md. Single frames: shaken picture"};
  }

  void declare(Arguments& arguments) override {
    options_.declare(arguments, true);
    arguments.option("--from", from_, "TIME", "Begins at this simulated time: 10, 10s, 500ms");
    arguments.option("--to", to_, "TIME", "Ends at this simulated time");
    arguments.option("--every", every_, "N", "Takes every N-th recorded frame; as the scene says if left out");
    arguments.option("--threads", threads_, "N", "Threads that draw; one per core if left out");
    arguments.option("--frame", frame_, "N|last", "One frame as a picture instead of a film");
    arguments.flag("--live", live_, "The present state of a running job as a picture");
    arguments.option("--lcm-url", lcm_url_, "URL", "With --live: the bus; the daemon's if left out");
  }

  ExitCode run(const Context& context) override {
    if (live_ && !frame_.empty()) throw Failure(ExitCode::kBadInput, "--live and --frame exclude each other");
    if (!frame_.empty() && frame_ != "last" && frame_.find_first_not_of("0123456789") != std::string::npos) {
      throw Failure(ExitCode::kBadInput, fmt::format("--frame takes a number from 0 or 'last', not '{}'", frame_));
    }
    const std::vector<Drawn> all = find_drawn(context, options_.jobs);
    const Drawn& drawn = all.front();
    if (live_ && all.size() > 1) throw Failure(ExitCode::kBadInput, "--live takes one job");
    if (live_) draw_live(context, drawn);
    if (!frame_.empty()) options_.draw(context, "picture", all, {{"--frame", frame_}}, ".png");
    options_.draw(context, "movie", all,
                  {{"--from", from_}, {"--to", to_}, {"--every", every_}, {"--threads", threads_}}, ".mp4");
  }

 private:
  [[noreturn]] void draw_live(const Context& context, const Drawn& drawn) const {
    if (drawn.id.empty()) throw Failure(ExitCode::kBadInput, "--live takes the ID of a running job, not a directory");
    if (!has_worker(drawn.state)) {
      throw Failure(ExitCode::kFailed,
                    fmt::format("job {} is {}: nothing of it is live. `shaken movie {} --frame last` draws its last "
                                "recorded frame",
                                drawn.name, drawn.state, options_.jobs.front()));
    }
    const std::string url =
        lcm_url_.empty() ? text_of(ApiClient(context.root()).get("/v1/status").at("lcm"), "url") : lcm_url_;
    const std::string out = options_.out.empty() ? drawn.name + ".png" : options_.out;
    std::vector<std::string> command{
        sibling_program("shaken-render").string(), "live", drawn.id, "--lcm-url", url, "-o", out};
    const std::vector<std::string> style = options_.words({});  // the messages say what was swept
    command.insert(command.end(), style.begin(), style.end());
    become(command);
  }

  PictureOptions options_;
  std::string from_, to_, every_, threads_, frame_, lcm_url_;
  bool live_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_movie() { return std::make_unique<Movie>(); }

}  // namespace shaken::client
