#include "client/picture_options.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Picture : public Verb {
 public:
  VerbInfo info() const override {
    return {"picture", kResultsGroup, "One frame of a job, or of several side by side, as a PNG, SVG or PDF",
            "  shaken picture 1f0c                                   -> 1f0c5e2a.png, the last frame\n"
            "  shaken picture 1f0c --time 12.5s --style defects -o d.png\n"
            "  shaken picture runs/first --style director --theme print -o fig4.pdf\n"
            "  shaken picture runs/first --colour tilt --zoom 3 --focus 0.2,0.7\n"
            "  shaken picture 1f0c 22ab 77c0 --time 20s -o three.png  three runs side by side\n"
            "  shaken picture runs/first --bare --inset angles       P(theta) in a corner of the rods\n"
            "  shaken picture runs/first --view follow:17            rod 17 in the middle\n"
            "Styles, colours and style files: docs/pictures.md"};
  }

  void declare(Arguments& arguments) override {
    options_.declare(arguments, false);
    arguments.option("--frame", frame_, "N|last", "The frame, counted from 0; the last if left out");
    arguments.option("--time", time_, "TIME", "The frame nearest to this simulated time: 12.5, 500ms");
    arguments.option("--depth", depth_, "8|16", "Bits a colour of a PNG; 8 if left out");
  }

  ExitCode run(const Context& context) override {
    if (!frame_.empty() && !time_.empty()) {
      throw Failure(ExitCode::kBadInput, "--frame and --time exclude each other");
    }
    options_.draw(context, "picture", find_drawn(context, options_.jobs),
                  {{"--frame", frame_}, {"--time", time_}, {"--depth", depth_}}, ".png");
  }

 private:
  PictureOptions options_;
  std::string frame_, time_, depth_;
};

}  // namespace

std::unique_ptr<Verb> make_picture() { return std::make_unique<Picture>(); }

}  // namespace shaken::client
