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
            "Styles, colours and style files: docs/pictures.md. Single frames: shaken picture",
            kExitCodesOfDaemon};
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
    if (live_) check_live(context, drawn);

    std::vector<std::string> command{sibling_program("shaken-render").string()};
    const auto add = [&](const std::vector<std::string>& words) {
      command.insert(command.end(), words.begin(), words.end());
    };
    if (live_) {
      add({"live", drawn.id, "--lcm-url", lcm_url_, "-o", out_or(drawn.name + ".png")});
      add(options_.words({}));  // the messages say what was swept
      become(command);
    }
    if (!frame_.empty()) {
      add({"picture"});
      for (const Drawn& one : all) add({one.directory});
      add({"--frame", frame_, "-o", out_or(drawn.name + ".png")});
    } else {
      add({"movie"});
      for (const Drawn& one : all) add({one.directory});
      add({"-o", out_or(drawn.name + ".mp4")});
      for (const auto& [option, value] :
           {std::pair{"--from=", from_}, {"--to=", to_}, {"--every=", every_}, {"--threads=", threads_}}) {
        if (!value.empty()) add({option + value});
      }
    }
    if (options_.shows_sweep()) add({"--sweep=" + sweep_of(context, all)});
    add(options_.words(labels_of(all)));
    become(command);
  }

 private:
  std::string out_or(const std::string& file) const { return options_.out.empty() ? file : options_.out; }

  void check_live(const Context& context, const Drawn& drawn) {
    if (drawn.id.empty()) throw Failure(ExitCode::kBadInput, "--live takes the ID of a running job, not a directory");
    if (!has_worker(drawn.state)) {
      throw Failure(ExitCode::kFailed,
                    fmt::format("job {} is {}: nothing of it is live. `shaken movie {} --frame last` draws its last "
                                "recorded frame",
                                drawn.name, drawn.state, options_.jobs.front()));
    }
    if (!lcm_url_.empty()) return;
    ApiClient session(context.root());
    lcm_url_ = text_of(session.get("/v1/status").at("lcm"), "url");
  }

  PictureOptions options_;
  std::string from_, to_, every_, threads_, frame_, lcm_url_;
  bool live_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_movie() { return std::make_unique<Movie>(); }

}  // namespace shaken::client
